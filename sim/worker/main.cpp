// hydroprint-worker: one computation, one process. See options.h for what it can be asked.

#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "sim/base/one_line.h"
#include "sim/worker/ending.h"
#include "sim/worker/errors.h"
#include "sim/worker/options.h"
#include "sim/worker/quiet_stderr.h"
#include "sim/worker/report.h"
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

/// What is freed is used again soon: memory that goes back to the system each time comes back page
/// by page, which takes a twentieth of a dip's time.
void keep_freed_memory() {
  constexpr int kMany = 256 << 20;
  ::mallopt(M_MMAP_THRESHOLD, kMany);
  ::mallopt(M_TRIM_THRESHOLD, kMany);
}

/// Runs and turns what libraries may throw into an error.
Result<Finished> run_guarded(const Options& options, Ending& ending, int stderr_fd) {
  const bool is_print = options.verb == Verb::kPrintImage;
  const std::string work = is_print                  ? options.film_image.string()
                           : !options.frames.empty() ? options.frames.front().string()
                           : options.mesh.empty()    ? "validate"
                                                     : options.mesh.string();
  try {
    return run(options, ending, stderr_fd);
  } catch (const std::bad_alloc&) {
    return fail(Code::kInternal,
                work + ": out of memory. Use a smaller model, a lower --dpi or more memory",
                "OUT_OF_MEMORY");
  } catch (const std::exception& error) {
    return fail(Code::kInternal, work + ": " + error.what() + ". Please report this");
  }
}

void sum_up(const Finished& finished, bool json) {
  const std::string text = json ? summary_json(finished.report, finished.dir)
                                : summary_text(finished.report, finished.dir);
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
  if (json) return;
  for (const Warning& warning : finished.report.warnings) {
    const std::string line = one_line(warning.message + " (" + warning.where + ")");
    std::fprintf(stderr, "hydroprint-worker: warning: %s\n", line.c_str());
  }
}

int main_of(int argc, char** argv) {
  occupy_standard_streams();
  keep_freed_memory();
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
  const QuietStderr quiet;
  Ending ending([&quiet, json] {
    quiet.restore();
    tell({Code::kCancelled, "cancelled", {}, {}}, ExitStatus::kCancelled, json);
  });
  const Result<Finished> finished = run_guarded(command.options, ending, quiet.own());
  ending.decide();
  quiet.restore();
  if (finished) {
    sum_up(*finished, json);
    return 0;
  }
  tell(finished.error(), exit_status(finished.error()), json);
  return static_cast<int>(exit_status(finished.error()));
}

}  // namespace
}  // namespace hydroprint::worker

int main(int argc, char** argv) { return hydroprint::worker::main_of(argc, argv); }
