// hydroprint-worker: one computation, one process. See options.h for what it can be asked.

#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <string>

#include "sim/base/one_line.h"
#include "sim/worker/ending.h"
#include "sim/worker/errors.h"
#include "sim/worker/options.h"
#include "sim/worker/preview.h"
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

/// Does `work`, and turns what libraries may throw into an error.
template <class Work>
auto guarded(const Options& options, const Work& work) -> decltype(work()) {
  const bool is_print = options.verb == Verb::kPrintImage;
  const std::string what = is_print                  ? options.film_image.string()
                           : !options.frames.empty() ? options.frames.front().string()
                           : options.mesh.empty()    ? "validate"
                                                     : options.mesh.string();
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return fail(Code::kInternal,
                what + ": out of memory. Use a smaller model, a lower --dpi or more memory",
                "OUT_OF_MEMORY");
  } catch (const std::exception& error) {
    return fail(Code::kInternal, what + ": " + error.what() + ". Please report this");
  }
}

/// Does what is asked; only what leaves a folder has something to sum up.
Result<std::optional<Finished>> obey(const Options& options, Ending& ending, int stderr_fd) {
  if (options.verb == Verb::kPreview) {
    HP_RETURN_IF_ERROR(run_preview(options, ending));
    return std::nullopt;
  }
  return run(options, ending, stderr_fd);
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
  const Result<std::optional<Finished>> finished =
      guarded(command.options, [&] { return obey(command.options, ending, quiet.own()); });
  ending.decide();
  quiet.restore();
  if (!finished) {
    tell(finished.error(), exit_status(finished.error()), json);
    return static_cast<int>(exit_status(finished.error()));
  }
  if (*finished) sum_up(**finished, json);
  return 0;
}

}  // namespace
}  // namespace hydroprint::worker

int main(int argc, char** argv) { return hydroprint::worker::main_of(argc, argv); }
