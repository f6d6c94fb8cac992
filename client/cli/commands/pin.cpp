#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/program/program.h"
#include "client/cli/terminal/console.h"
#include "client/jobs.h"
#include "client/time.h"

namespace hydroprint::cli {
namespace {

std::string fate_of(const v1::Job& job) {
  if (job.pinned()) return "is pinned";
  if (!job.has_purge_time()) return "is no longer pinned";
  return "will be deleted on " + format_time(client::time_of(job.purge_time()));
}

Status pin(Program& program, const std::vector<std::string>& names, bool pinned) {
  Json all = Json::array();
  for (const std::string& name : names) {
    HP_ASSIGN_OR_RETURN(const v1::Job job,
                        client::pin_job(program.daemon(), job_name(name), pinned));
    if (!program.json()) std::cout << printable(job.name()) << " " << fate_of(job) << std::endl;
    all.push_back(to_json(job));
  }
  if (program.json()) print({{"jobs", all}});
  return {};
}

void add(CLI::App& app, Program& program, const char* verb, const char* help, bool pinned) {
  auto jobs = std::make_shared<std::vector<std::string>>();
  CLI::App* command = app.add_subcommand(verb, help);
  command->add_option("job", *jobs, "The jobs: jobs/7, or 7")->type_name("JOB")->required();
  program.on(*command, [&program, jobs, pinned] { return pin(program, *jobs, pinned); });
}

}  // namespace

void add_pin(CLI::App& app, Program& program) {
  add(app, program, "pin", "Pin jobs: retention keeps them with their artifacts", true);
  add(app, program, "unpin", "Unpin jobs; retention starts again from now", false);
}

}  // namespace hydroprint::cli
