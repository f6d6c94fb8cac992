#include "tests/daemon/workers/adoption/detached_executor.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>

#include <fstream>

#include "daemon/platform/durable_file.h"
#include "daemon/workers/worker_outcome.h"
#include "tests/support/content.h"

namespace hydroprint::daemon {
namespace {

using hydroprint::testing::content;

// Arguments: FOLDER RECORDS JOB ATTEMPT PROGRAM [ARGUMENT...]. A file appears complete, by rename.
constexpr const char* kRunner = R"sh(
folder=$1 records=$2
echo "$3 $4" >> "$records/starts"
shift 4
cd "$folder/in" || exit 1
"$@" 4>&3 3>>"$folder/progress" >"$folder/answer" 2>"$folder/errors" </dev/null &
echo $! > "$folder/begin.new" && mv "$folder/begin.new" "$folder/begin"
wait $!
echo $? > "$folder/exit.new" && mv "$folder/exit.new" "$folder/exit"
)sh";
constexpr int kLockFd = 3;

struct flock whole_file() {
  struct flock out {};
  out.l_type = F_WRLCK;
  return out;
}

// Locks the file until the last copy of its descriptor is closed; invalid if it is locked already.
UniqueFd lock(const std::filesystem::path& folder) {
  UniqueFd file(::open((folder / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  struct flock wanted = whole_file();
  if (file.valid() && ::fcntl(file.get(), F_OFD_SETLK, &wanted) != 0) file.reset();
  return file;
}

std::vector<std::string> arguments_of(const Execution& execution, const Launch& launch,
                                      const std::filesystem::path& records) {
  std::vector<std::string> out{"/bin/sh",
                               "-c",
                               kRunner,
                               "runner",
                               execution.folder.string(),
                               records.string(),
                               std::to_string(execution.job),
                               std::to_string(execution.attempt),
                               launch.program.string()};
  out.insert(out.end(), launch.arguments.begin(), launch.arguments.end());
  out.push_back("--progress-fd=" + std::to_string(kProgressFd));
  return out;
}

// Starts a program in a session of its own. It has the lock as descriptor kLockFd, and no other
// descriptor of the caller, which it may survive. Returns its process id; 0 if it cannot be
// started.
pid_t spawn_detached(std::vector<std::string> arguments, int lock_fd) {
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_t actions;
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK);
  sigset_t none;
  ::sigemptyset(&none);
  ::posix_spawnattr_setsigmask(&attributes, &none);
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, lock_fd, kLockFd);
  ::posix_spawn_file_actions_addclosefrom_np(&actions, kLockFd + 1);
  for (const int fd : {1, 2}) {  // the caller's output ends with the caller
    ::posix_spawn_file_actions_addopen(&actions, fd, "/dev/null", O_WRONLY, 0);
  }
  pid_t pid = 0;
  const int error = ::posix_spawn(&pid, "/bin/sh", &actions, &attributes, pointers.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::posix_spawnattr_destroy(&attributes);
  return error == 0 ? pid : 0;
}

// The shell reports a signal N as status 128 + N.
int wait_status_of(int shell_status) {
  const bool is_signal = shell_status == 128 + SIGKILL || shell_status == 128 + SIGTERM;
  return is_signal ? shell_status - 128 : shell_status << 8;
}

}  // namespace

bool lives(const std::filesystem::path& folder) {
  const UniqueFd file(::open((folder / "lock").c_str(), O_RDWR | O_CLOEXEC));
  struct flock held = whole_file();
  return file.valid() && ::fcntl(file.get(), F_OFD_GETLK, &held) == 0 && held.l_type != F_UNLCK;
}

Result<std::string> DetachedExecutor::start(const Execution& execution, const Launch& launch) {
  const UniqueFd held = lock(execution.folder);
  if (!held.valid()) return fail(Code::kInternal, "the execution runs already");
  progress_[execution.job].clear();
  const pid_t pid = spawn_detached(arguments_of(execution, launch, records_), held.get());
  if (pid == 0) return fail(Code::kInternal, "cannot start a process");
  return std::to_string(pid);
}

std::vector<std::string> DetachedExecutor::new_progress(const Execution& execution) {
  std::string& seen = progress_[execution.job];
  const std::string all = content(execution.folder / "progress");
  std::string fresh = all.substr(std::min(seen.size(), all.size()));
  auto lines = take_progress_lines(fresh);
  seen = all.substr(0, all.size() - fresh.size());
  return lines;
}

Observation DetachedExecutor::observe(const Execution& execution) {
  const auto& folder = execution.folder;
  // Asked first: a worker that has just ended has left its exit file.
  const bool is_alive = lives(folder);
  const std::string status = content(folder / "exit");
  if (!status.empty()) {
    return WorkerEnds{wait_status_of(std::stoi(status)), new_progress(execution),
                      content(folder / "errors"), content(folder / "answer")};
  }
  if (is_alive) return WorkerRuns{new_progress(execution)};
  return WorkerIsGone();
}

Observations DetachedExecutor::poll(const std::vector<Execution>& executions) {
  Observations out;
  if (is_mute()) return out;
  for (const Execution& execution : executions) out.emplace(execution.job, observe(execution));
  return out;
}

Status DetachedExecutor::cancel(const Execution& execution, CancelHow how) {
  const std::string worker = content(execution.folder / "begin");
  if (is_mute() || worker.empty()) return fail(Code::kUnavailable, "no answer");
  ::kill(std::stoi(worker), how == CancelHow::kGently ? SIGTERM : SIGKILL);
  return {};
}

Adoption DetachedExecutor::adopt(const Execution& execution) {
  std::ofstream(records_ / "offers", std::ios::app)
      << std::to_string(execution.job) + " " + std::to_string(execution.attempt) + "\n";
  if (is_mute()) return Adoption::kNoAnswer;
  return std::holds_alternative<WorkerIsGone>(observe(execution)) ? Adoption::kGone
                                                                  : Adoption::kAdopted;
}

}  // namespace hydroprint::daemon
