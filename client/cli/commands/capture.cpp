#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/job_io/field_help.h"
#include "client/cli/job_io/finish.h"
#include "client/cli/program/program.h"
#include "client/jobs.h"

namespace hydroprint::cli {
namespace {

struct CaptureOptions {
  std::optional<double> seconds;
  client::JobOptions job;
  FinishOptions finish;
};

Status capture(Program& program, const CaptureOptions& options) {
  HP_ASSIGN_OR_RETURN(const v1::Job job,
                      client::create_capture(program.daemon(), options.seconds, options.job));
  return finish_job(program, job, options.finish);
}

}  // namespace

void add_capture(CLI::App& app, Program& program) {
  auto options = std::make_shared<CaptureOptions>();
  CLI::App* command = app.add_subcommand("capture", "Record depth frames with the daemon's camera");
  command->add_option("--seconds", options->seconds, field_help("CaptureSpec.seconds"))
      ->type_name("S");
  command->add_option("--name", options->job.display_name, "Display name of the job")
      ->type_name("TEXT");
  add_finish_flags(*command, options->finish);
  command->footer(
      "The axis position is recorded. A calibration from these frames is valid until the axis "
      "moves.\n\n"
      "Example:\n"
      "  hydroprint capture --out frames");
  program.on(*command, [&program, options] { return capture(program, *options); });
}

}  // namespace hydroprint::cli
