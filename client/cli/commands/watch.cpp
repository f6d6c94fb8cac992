#include <unistd.h>

#include <memory>
#include <string>

#include "client/cli/commands/commands.h"
#include "client/cli/job_io/wait.h"
#include "client/cli/program/program.h"

namespace hydroprint::cli {
namespace {

struct WatchOptions {
  std::string job;
  WaitOptions wait;
};

Status watch(Program& program, WatchOptions options) {
  options.wait.json_lines = program.json();
  options.wait.descriptor = STDOUT_FILENO;
  HP_RETURN_IF_ERROR(wait_for(program, job_name(options.job), options.wait));
  return {};
}

}  // namespace

void add_watch(CLI::App& app, Program& program) {
  auto options = std::make_shared<WatchOptions>();
  CLI::App* command = app.add_subcommand("watch", "Follow a job until it is finished");
  add_job_argument(*command, options->job);
  add_wait_flags(*command, options->wait);
  command->footer(
      "Shows a progress bar and the time left on a terminal, and lines elsewhere; with --json, "
      "one\n"
      "line of JSON for each event. Exits with 0 only if the job succeeds. Reconnects if the\n"
      "connection is lost.\n\n"
      "Example:\n"
      "  hydroprint watch 7");
  program.on(*command, [&program, options] { return watch(program, *options); });
}

}  // namespace hydroprint::cli
