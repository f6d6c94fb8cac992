#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/program/program.h"
#include "client/jobs.h"
#include "client/name_of.h"

namespace hydroprint::cli {
namespace {

Status cancel(Program& program, const std::vector<std::string>& names) {
  Json jobs = Json::array();
  for (const std::string& name : names) {
    HP_ASSIGN_OR_RETURN(const v1::Job job, client::cancel_job(program.daemon(), job_name(name)));
    jobs.push_back(to_json(job));
    if (!program.json())
      std::cout << job.name() << " is " << client::name_of(job.state()) << std::endl;
  }
  if (program.json()) print({{"jobs", jobs}});
  return {};
}

}  // namespace

void add_cancel(CLI::App& app, Program& program) {
  auto jobs = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand("cancel", "Cancel queued or running jobs");
  command->add_option("job", *jobs, "The jobs: jobs/7, or 7")->type_name("JOB")->required();
  program.on(*command, [&program, jobs] { return cancel(program, *jobs); });
}

}  // namespace hydroprint::cli
