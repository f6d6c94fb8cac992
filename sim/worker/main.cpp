// hydroprint-worker: one computation, one process. See options.h for what it can be asked.

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "sim/worker/ending.h"
#include "sim/worker/errors.h"
#include "sim/worker/options.h"
#include "sim/worker/run.h"

namespace hydroprint::worker {
namespace {

/// A file opened later must not take the number of a stream that the caller closed: what is said
/// there would end up in it.
void occupy_standard_streams() {
  for (int fd = ::open("/dev/null", O_RDWR); fd >= 0; fd = ::open("/dev/null", O_RDWR)) {
    if (fd > 2) {
      ::close(fd);
      return;
    }
  }
}

/// Runs and turns what libraries may throw into an error.
Status run_guarded(const Options& options, Ending& ending) {
  const std::string mesh = options.mesh.string();
  try {
    return run(options, ending);
  } catch (const std::bad_alloc&) {
    return fail(Code::kInternal,
                mesh + ": out of memory. Use a smaller model, a lower --dpi or more memory",
                "OUT_OF_MEMORY");
  } catch (const std::exception& error) {
    return fail(Code::kInternal, mesh + ": " + error.what() + ". Please report this");
  }
}

int main_of(int argc, char** argv) {
  occupy_standard_streams();
  const CommandLine command = parse_command_line(argc, argv);
  switch (command.action) {
    case CommandLine::Action::kPrint:
      std::fputs(command.text.c_str(), stdout);
      return 0;
    case CommandLine::Action::kRefuse:
      tell(command.error, command.status, command.options.json);
      return static_cast<int>(command.status);
    case CommandLine::Action::kRun:
      break;
  }
  const bool json = command.options.json;
  Ending ending([json] {
    tell({Code::kCancelled, "cancelled", {}, {}}, ExitStatus::kCancelled, json);
  });
  const Status status = run_guarded(command.options, ending);
  if (status) return 0;
  ending.decide();
  tell(status.error(), exit_status(status.error()), json);
  return static_cast<int>(exit_status(status.error()));
}

}  // namespace
}  // namespace hydroprint::worker

int main(int argc, char** argv) { return hydroprint::worker::main_of(argc, argv); }
