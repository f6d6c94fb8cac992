#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/program/program.h"
#include "client/cli/terminal/console.h"
#include "client/jobs.h"

namespace hydroprint::cli {
namespace {

struct ListOptions {
  client::JobFilter filter;
  std::vector<std::string> states;
  bool mine = false;
};

const std::map<std::string, client::JobState>& states_by_name() {
  using enum client::JobState;
  static const auto kStates = [] {
    std::map<std::string, client::JobState> states;
    for (const auto state : {kQueued, kWaitingForOperator, kRunning, kCancelling, kSucceeded,
                             kFailed, kCancelled, kInterrupted})
      states.emplace(client::name_of(state), state);
    return states;
  }();
  return kStates;
}

void print_table(const std::vector<client::Job>& jobs) {
  std::cout << std::left << std::setw(12) << "JOB" << std::setw(22) << "STATE" << std::setw(6)
            << "DONE" << std::setw(21) << "CREATED" << std::setw(14) << "OWNER"
            << "NAME\n";
  for (const client::Job& job : jobs) {
    const auto done = std::to_string(std::lround(100 * job.progress_fraction)) + "%";
    std::cout << std::setw(12) << job.name << std::setw(22) << client::name_of(job.state)
              << std::setw(6) << done << std::setw(21) << format_time(job.create_time)
              << std::setw(14) << printable(job.owner) << printable(job.display_name) << "\n";
  }
}

Status list(Program& program, const ListOptions& options) {
  client::JobFilter filter = options.filter;
  if (options.mine) {
    HP_ASSIGN_OR_RETURN(filter.owner, program.own_name());
  }
  for (const std::string& state : options.states)
    filter.states.push_back(states_by_name().at(state));
  HP_ASSIGN_OR_RETURN(const auto jobs, client::list_jobs(program.daemon(), filter));
  if (program.json())
    print({{"jobs", to_json(jobs)}});
  else
    print_table(jobs);
  return {};
}

}  // namespace

void add_list(CLI::App& app, Program& program) {
  auto options = std::make_shared<ListOptions>();
  CLI::App* command = app.add_subcommand("list", "List jobs, newest first");
  std::vector<std::string> names;
  for (const auto& [name, state] : states_by_name()) names.push_back(name);
  command->add_option("--state", options->states, "Only jobs in this state; may be repeated")
      ->type_name("STATE")
      ->transform(CLI::IsMember(names, CLI::ignore_case));
  command->add_flag("--mine", options->mine,
                    "Only your jobs; without user accounts, those of --owner");
  command->add_option("--limit", options->filter.limit, "Maximum number")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command->footer("Example:\n  hydroprint list --mine --state FAILED --json");
  program.on(*command, [&program, options] { return list(program, *options); });
}

}  // namespace hydroprint::cli
