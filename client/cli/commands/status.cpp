#include <fmt/format.h>

#include <iostream>

#include "client/cli/commands/commands.h"
#include "client/cli/format/json.h"
#include "client/cli/program/program.h"
#include "client/cli/terminal/console.h"
#include "client/connection/health.h"
#include "client/queue.h"

namespace hydroprint::cli {
namespace {

void show(const Program& program, const std::string& health, const v1::Queue& queue) {
  if (program.json()) {
    print({{"server", program.server()}, {"health", health}, {"queue", to_json(queue)}});
    return;
  }
  std::cout << "hydroprintd " << queue.daemon_version() << " at " << program.server() << ": "
            << health << "\n"
            << queue.running_jobs_size() << " running on " << queue.worker_slots() << " workers, "
            << queue.queued_count() << " queued"
            << (queue.paused() ? ", paused: " + printable(queue.pause_reason()) : "") << "\n";
  if (!queue.blocked_reason().empty()) {
    std::cout << "no job starts: " << printable(queue.blocked_reason()) << "\n";
  }
}

Status status(Program& program) {
  HP_ASSIGN_OR_RETURN(const std::string health, client::check_health(program.daemon()));
  HP_ASSIGN_OR_RETURN(const v1::Queue queue, client::get_queue(program.daemon()));
  show(program, health, queue);
  if (health != "SERVING")
    return fail(Code::kUnavailable,
                fmt::format("{}: hydroprintd reports {}; see its log for the reason",
                            program.server(), health));
  return {};
}

}  // namespace

void add_status(CLI::App& app, Program& program) {
  CLI::App* command = app.add_subcommand("status", "Show the status of the daemon and its queue");
  program.on(*command, [&program] { return status(program); });
}

}  // namespace hydroprint::cli
