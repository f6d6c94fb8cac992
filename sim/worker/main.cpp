// hydroprint-worker: runs one computation per process. registry.h lists its verbs.

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include "sim/base/process/error_output.h"
#include "sim/base/process/quiet_stderr.h"
#include "sim/base/process/termination.h"
#include "sim/worker/command_line.h"
#include "sim/worker/common/fields.h"

namespace hydroprint::worker {
namespace {

/// Opens /dev/null for each standard stream that the caller closed. Otherwise a file opened later
/// could get the stream's number and receive its output.
void occupy_standard_streams() {
  for (int fd = ::open("/dev/null", O_RDWR); fd >= 0; fd = ::open("/dev/null", O_RDWR)) {
    if (fd > 2) {
      ::close(fd);
      return;
    }
  }
}

/// Keeps freed memory in the process, because it is soon needed again. Returning it to the system
/// would cost 5 % of a dip's time in page faults.
void keep_freed_memory() {
  constexpr int kMany = 256 << 20;
  ::mallopt(M_MMAP_THRESHOLD, kMany);
  ::mallopt(M_TRIM_THRESHOLD, kMany);
}

/// With `--json`, reports OUT_OF_MEMORY on stdout and ends the program if memory runs out in code
/// that must not throw. Other exceptions abort the program as usual.
[[noreturn]] void on_terminate() {
  try {
    if (std::current_exception()) std::rethrow_exception(std::current_exception());
  } catch (const std::bad_alloc&) {
    constexpr std::string_view kAnswer = "{\"error\":{\"reason\":\"OUT_OF_MEMORY\"}}\n";
    const bool written = ::write(STDOUT_FILENO, kAnswer.data(), kAnswer.size()) > 0;
    if (written) ::_exit(static_cast<int>(ExitStatus::kFailed));
  } catch (...) {
  }
  std::abort();
}

/// Runs the task and converts exceptions of libraries to errors.
Result<Finished> run(const CommandLine& command, Termination& termination, int stderr_fd) {
  const std::string subject = command.task->subject();
  try {
    return command.task->run(command.run, termination, stderr_fd);
  } catch (const std::bad_alloc&) {
    return fail(Code::kInternal,
                fmt::format("{}: out of memory. Use {} or more memory", subject,
                            command.task->memory_tip()),
                "OUT_OF_MEMORY");
  } catch (const std::exception& error) {
    return fail(Code::kInternal, subject + ": " + error.what() + ". Please report this");
  }
}

int refuse(const Error& error, ExitStatus status, bool json) {
  print_error(error, status, json);
  return static_cast<int>(status);
}

void print_result(const Finished& finished, bool json) {
  std::fputs(finished.summary.c_str(), stdout);
  std::fflush(stdout);
  if (json) return;
  for (const std::string& warning : finished.warnings)
    std::fprintf(stderr, "hydroprint-worker: warning: %s\n", warning.c_str());
}

int main_of(int argc, char** argv) {
  occupy_standard_streams();
  keep_freed_memory();
  const CommandLine command = parse_command_line(argc, argv);
  const bool json = command.run.json;
  if (json) std::set_terminate(on_terminate);
  switch (command.action) {
    case CommandLine::Action::kPrint:
      std::fputs(command.text.c_str(), stdout);
      return 0;
    case CommandLine::Action::kRefuse:
      return refuse(command.error, command.status, json);
    case CommandLine::Action::kRun:
      break;
  }
  const QuietStderr quiet;
  Termination termination([&quiet, json] {
    quiet.restore();
    print_error({Code::kCancelled, "cancelled", {}, {}}, ExitStatus::kCancelled, json);
  });
  const Result<Finished> finished = run(command, termination, quiet.own());
  termination.decide();
  quiet.restore();
  if (!finished) {
    return refuse(name_field(finished.error(), command.uses_flags), exit_status(finished.error()),
                  json);
  }
  print_result(*finished, json);
  return 0;
}

}  // namespace
}  // namespace hydroprint::worker

int main(int argc, char** argv) { return hydroprint::worker::main_of(argc, argv); }
