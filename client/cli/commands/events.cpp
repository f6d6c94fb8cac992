#include <cmath>
#include <iostream>
#include <memory>
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/format/job_display.h"
#include "client/cli/format/json.h"
#include "client/cli/program/program.h"
#include "client/cli/terminal/console.h"
#include "client/jobs.h"
#include "client/name_of.h"
#include "client/time.h"

namespace hydroprint::cli {
namespace {

Status events(Program& program, const std::string& name) {
  HP_ASSIGN_OR_RETURN(const auto list, client::list_job_events(program.daemon(), name));
  if (program.json()) {
    print(list);
    return {};
  }
  for (const v1::JobEvent& event : list.events())
    std::cout << format_time(client::time_of(event.time())) << "  " << client::name_of(event.kind())
              << "  " << client::name_of(event.state()) << "  "
              << std::lround(100 * event.progress_fraction()) << "%  "
              << printable(phase_text(event.phase(), event.waits_for())) << "  "
              << printable(event.message()) << "\n";
  return {};
}

}  // namespace

void add_events(CLI::App& app, Program& program) {
  auto job = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("events", "List the events of a job, oldest first");
  add_job_argument(*command, *job);
  program.on(*command, [&program, job] { return events(program, job_name(*job)); });
}

}  // namespace hydroprint::cli
