#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/program/program.h"
#include "client/jobs.h"

namespace hydroprint::cli {
namespace {

Status delete_jobs(Program& program, const std::vector<std::string>& names) {
  Json deleted = Json::array();
  for (const std::string& text : names) {
    const std::string name = job_name(text);
    HP_RETURN_IF_ERROR(client::delete_job(program.daemon(), name));
    deleted.push_back(name);
    if (!program.json()) std::cout << name << " deleted" << std::endl;
  }
  if (program.json()) print({{"deleted", deleted}});
  return {};
}

}  // namespace

void add_delete(CLI::App& app, Program& program) {
  auto jobs = std::make_shared<std::vector<std::string>>();
  CLI::App* command =
      app.add_subcommand("delete", "Delete finished jobs with their events and artifacts");
  command->add_option("job", *jobs, "The jobs: jobs/7, or 7")->type_name("JOB")->required();
  program.on(*command, [&program, jobs] { return delete_jobs(program, *jobs); });
}

}  // namespace hydroprint::cli
