// hydroprint-confine limits itself to what a worker needs, and becomes the worker. It is a program
// of its own, so that the daemon and the scripts of a cluster confine workers in the same way.

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "daemon/config/executable_path.h"
#include "daemon/confine/granted.h"
#include "daemon/confine/options.h"
#include "daemon/confine/sandbox.h"
#include "daemon/platform/durable_file.h"
#include "sim/base/result.h"

namespace hydroprint::confine {
namespace {

/// The first descriptor that the program does not inherit.
constexpr unsigned kFirstClosed = 4;

/// Returns the path of the program: `name` if it is a path, otherwise the file in PATH.
std::filesystem::path path_of(const std::string& name) {
  if (name.find('/') != std::string::npos) return name;
  const char* const search_path = std::getenv("PATH");
  return daemon::find_program(name, search_path == nullptr ? "" : search_path);
}

void require_folder(const std::filesystem::path& path) {
  const daemon::UniqueFd folder(::open(path.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (!folder.valid()) give_up(path.c_str());
}

/// Opens the file for `--granted`, which the confined process may not open any more.
daemon::UniqueFd open_granted(const std::filesystem::path& path) {
  if (path.empty()) return {};
  daemon::UniqueFd file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
  if (!file.valid()) give_up(path.c_str());
  return file;
}

void write_granted(const daemon::UniqueFd& file, const std::filesystem::path& path) {
  if (!file.valid()) return;
  const std::string text = granted_json(true);
  errno = ENOSPC;  // the reason of an incomplete write
  if (::write(file.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    give_up(path.c_str());
  }
}

// With these variables, OpenMP starts each thread with a call that is refused, and gives up.
void forget_places() {
  for (const char* name : {"OMP_PLACES", "OMP_PROC_BIND", "GOMP_CPU_AFFINITY"}) ::unsetenv(name);
}

[[noreturn]] void become(const std::filesystem::path& program, std::vector<std::string> command) {
  std::vector<char*> arguments;
  for (std::string& text : command) arguments.push_back(text.data());
  arguments.push_back(nullptr);
  forget_places();
  ::close_range(kFirstClosed, ~0U, 0);
  ::execv(program.c_str(), arguments.data());
  give_up(command.front().c_str());
}

[[noreturn]] void run(const Options& options) {
  const std::filesystem::path program = path_of(options.command.front());
  require_folder(options.inputs);
  require_folder(options.work);
  const daemon::UniqueFd file = open_granted(options.granted);
  if (const char* const step = confine(options.limits, {program, options.inputs, options.work})) {
    give_up(step);
  }
  write_granted(file, options.granted);
  become(program, options.command);
}

int check(const Options& options) {
  const char* const step = confine(options.limits, {});
  const int reason = errno;
  fmt::print("{}", granted_json(step == nullptr));
  if (step != nullptr) {
    fmt::print(stderr, "this machine cannot confine workers ({}: {})\n", step,
               std::strerror(reason));
    return static_cast<int>(ExitStatus::kFailed);
  }
  if (landlock_version() == 0) {
    fmt::print(stderr,
               "without Landlock, workers can read, write and delete every file that the daemon's "
               "user may; use a kernel and a container that have it\n");
  }
  return static_cast<int>(ExitStatus::kDone);
}

}  // namespace
}  // namespace hydroprint::confine

int main(int argc, char** argv) {
  using namespace hydroprint::confine;  // NOLINT(google-build-using-namespace): the program itself
  const CommandLine line = parse_command_line(argc, argv);
  if (!line.runs) {
    std::fputs(line.text.c_str(), line.status == 0 ? stdout : stderr);
    return line.status;
  }
  if (line.options.check) return check(line.options);
  run(line.options);
}
