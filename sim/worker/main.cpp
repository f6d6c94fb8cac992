// hydroprint-worker: runs one computation per process. registry.h lists its verbs.

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
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

/// With `--json`, reports MEMORY_LIMIT on stdout and ends the program if memory runs out in code
/// that must not throw. Other exceptions abort the program as usual.
[[noreturn]] void on_terminate() {
  try {
    if (std::current_exception()) std::rethrow_exception(std::current_exception());
  } catch (const std::bad_alloc&) {
    constexpr std::string_view kAnswer = "{\"error\":{\"reason\":\"MEMORY_LIMIT\"}}\n";
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
                ErrorReason::MEMORY_LIMIT);
  } catch (const std::exception& error) {
    return fail(Code::kInternal, subject + ": " + error.what() + ". Please report this");
  }
}

/// Returns the error's message after its field, as the user wrote it: "--dpi", or a field of a
/// spec.
std::string words_of(const Error& error, const std::optional<std::string>& spec_file) {
  if (error.field.empty()) return error.message;
  if (spec_file) return fmt::format("{}: {}", *spec_file, full_message(error));
  return fmt::format("{}: {}", flag_of(error.field), error.message);
}

int refuse(const Error& error, ExitStatus status, const CommandLine& command) {
  if (command.run.json) print_failure(error, status);
  print_error("hydroprint-worker", words_of(error, command.spec_file));
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
      return refuse(command.error, command.status, command);
    case CommandLine::Action::kRun:
      break;
  }
  const QuietStderr quiet;
  Termination termination([&quiet, &command] {
    quiet.restore();
    refuse({Code::kCancelled, "cancelled"}, ExitStatus::kCancelled, command);
  });
  const Result<Finished> finished = run(command, termination, quiet.own());
  termination.decide();
  quiet.restore();
  if (!finished) return refuse(finished.error(), exit_status(finished.error()), command);
  print_result(*finished, json);
  return 0;
}

}  // namespace
}  // namespace hydroprint::worker

int main(int argc, char** argv) { return hydroprint::worker::main_of(argc, argv); }
