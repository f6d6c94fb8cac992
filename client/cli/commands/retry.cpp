#include <iostream>
#include <memory>
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/program/program.h"
#include "client/jobs.h"

namespace hydroprint::cli {
namespace {

Status retry(Program& program, const std::string& name) {
  HP_ASSIGN_OR_RETURN(const v1::Job job, client::retry_job(program.daemon(), name));
  if (program.json())
    print(job);
  else
    std::cout << job.name() << std::endl;
  return {};
}

}  // namespace

void add_retry(CLI::App& app, Program& program) {
  auto job = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("retry", "Queue a finished job again, as a new job");
  add_job_argument(*command, *job);
  command->footer(
      "The job is computed again; cached results are not used.\n\n"
      "Example:\n"
      "  hydroprint watch $(hydroprint retry 7)");
  program.on(*command, [&program, job] { return retry(program, job_name(*job)); });
}

}  // namespace hydroprint::cli
