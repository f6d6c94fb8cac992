#include <memory>
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/job_io/finish.h"
#include "client/cli/job_io/wait.h"
#include "client/cli/program/program.h"
#include "client/jobs.h"

namespace hydroprint::cli {
namespace {

struct PrintOptions {
  std::string print_image_job, out;
  client::JobOptions job;
  bool no_wait = false;
  WaitOptions wait;
};

// Downloads the record in any case: every print has one, regardless of its outcome.
Status follow_to_end(Program& program, const std::string& name, const PrintOptions& options) {
  const auto ended = wait_for(program, name, options.wait);
  Result<std::vector<Downloaded>> files;
  if (!options.out.empty() && !program.is_interrupted())
    files = download_all(program.daemon(), name, {}, options.out);
  if (!ended) return tl::unexpected(ended.error());
  if (!files) return tl::unexpected(files.error());
  if (!program.json()) return {};
  Json json = to_json(*ended);
  if (!options.out.empty()) json["files"] = files_json(*files);
  print(json);
  return {};
}

Status print_pages(Program& program, const PrintOptions& options) {
  HP_ASSIGN_OR_RETURN(
      const v1::Job job,
      client::create_print(program.daemon(), job_name(options.print_image_job), options.job));
  if (options.job.validate_only) {
    tell_valid(program, job);
    return {};
  }
  if (options.no_wait || !program.json()) tell_created(program, job);
  return options.no_wait ? Status() : follow_to_end(program, job.name(), options);
}

}  // namespace

void add_print(CLI::App& app, Program& program) {
  auto options = std::make_shared<PrintOptions>();
  CLI::App* command =
      app.add_subcommand("print", "Send a print-image job's PDF to the daemon's printer");
  command->add_option("job", options->print_image_job, "The print-image job: jobs/7, or 7")
      ->type_name("JOB")
      ->required();
  command->add_option("--name", options->job.display_name, "Display name of the job")
      ->type_name("TEXT");
  command->add_option("--out", options->out, "Download the print's record into this folder")
      ->type_name("DIR");
  command->add_flag("--no-wait", options->no_wait, "Do not wait until the print is finished");
  command->add_flag("--validate-only", options->job.validate_only, "Check, but print nothing");
  add_wait_flags(*command, options->wait);
  command->footer(
      "Exits with 0 only if the printer reports that the print is complete. Until then, this\n"
      "command shows the printer's messages (out of paper, ...) and warns of anything that may\n"
      "change the scale. Measure the rulers on the page: 200 mm. Nothing is sent twice: after an\n"
      "error, check the printer before you print again.\n\n"
      "Example:\n"
      "  hydroprint submit print-image --simulate-job 7 --wait\n"
      "  hydroprint print 8");
  program.on(*command, [&program, options] { return print_pages(program, *options); });
}

}  // namespace hydroprint::cli
