#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/program/program.h"
#include "client/cli/terminal/console.h"
#include "client/jobs.h"
#include "client/name_of.h"
#include "client/time.h"

namespace hydroprint::cli {
namespace {

struct ListOptions {
  client::JobFilter filter;
  std::vector<std::string> states;
  bool mine = false;
};

// Names of all states of a job.
std::vector<std::string> state_names() {
  std::vector<std::string> names;
  for (int i = 1; i < v1::Job::State_descriptor()->value_count(); ++i)
    names.push_back(v1::Job::State_descriptor()->value(i)->name());
  return names;
}

void print_table(const v1::ListJobsResponse& list) {
  constexpr const char* kRow = "{:<12}{:<22}{:<6}{:<21}{:<14}{}\n";
  std::cout << fmt::format(kRow, "JOB", "STATE", "DONE", "CREATED", "OWNER", "NAME");
  for (const v1::Job& job : list.jobs()) {
    std::cout << fmt::format(kRow, job.name(), client::name_of(job.state()),
                             fmt::format("{:.0f}%", 100 * job.progress_fraction()),
                             format_time(client::time_of(job.create_time())),
                             printable(job.owner()), printable(job.display_name()));
  }
}

Status list(Program& program, const ListOptions& options) {
  client::JobFilter filter = options.filter;
  if (options.mine && filter.owner.empty()) {
    HP_ASSIGN_OR_RETURN(filter.owner, program.own_name());
  }
  for (const std::string& name : options.states)
    v1::Job::State_Parse(name, &filter.states.emplace_back());
  HP_ASSIGN_OR_RETURN(const auto jobs, client::list_jobs(program.daemon(), filter));
  if (program.json())
    print(jobs);
  else
    print_table(jobs);
  return {};
}

}  // namespace

void add_list(CLI::App& app, Program& program) {
  auto options = std::make_shared<ListOptions>();
  CLI::App* command = app.add_subcommand("list", "List jobs, newest first");
  command->add_option("--state", options->states, "Only jobs in this state; may be repeated")
      ->type_name("STATE")
      ->transform(CLI::IsMember(state_names(), CLI::ignore_case));
  command->add_flag("--mine", options->mine,
                    "Only your jobs; without user accounts, those of --owner");
  command->add_option("--owner", options->filter.owner, "Only jobs of this owner")
      ->type_name("NAME");
  command->add_option("--limit", options->filter.limit, "Maximum number of jobs")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->footer("Example:\n  hydroprint list --mine --state FAILED --json");
  program.on(*command, [&program, options] { return list(program, *options); });
}

}  // namespace hydroprint::cli
