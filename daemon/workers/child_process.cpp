#include "daemon/workers/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "daemon/workers/worker_outcome.h"

namespace hydroprint::daemon {
namespace {

struct Pipe {
  UniqueFd read;
  UniqueFd write;
};

// Creates a pipe with descriptors above those that the child uses; the daemon's end is
// non-blocking.
Result<Pipe> make_pipe(UniqueFd Pipe::*ours = &Pipe::read) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return system_failure("pipe", "cannot be created");
  const UniqueFd low_read(ends[0]), low_write(ends[1]);
  Pipe pipe{UniqueFd(::fcntl(ends[0], F_DUPFD_CLOEXEC, 10)),
            UniqueFd(::fcntl(ends[1], F_DUPFD_CLOEXEC, 10))};
  if (!pipe.read.valid() || !pipe.write.valid() ||
      ::fcntl((pipe.*ours).get(), F_SETFL, O_NONBLOCK) != 0) {
    return system_failure("pipe", "cannot be created");
  }
  return pipe;
}

/// Returns the worker's stdin: a pipe for requests, or /dev/null.
Result<Pipe> make_stdin(bool is_asked) {
  if (is_asked) return make_pipe(&Pipe::write);
  const UniqueFd null(::open("/dev/null", O_RDWR | O_CLOEXEC));
  return Pipe{UniqueFd(::fcntl(null.get(), F_DUPFD_CLOEXEC, 10)), {}};
}

// Returns the environment of a worker. Of the daemon's variables, only those for the loader and for
// sanitizers are passed on.
std::vector<std::string> make_environment(const std::filesystem::path& work) {
  std::vector<std::string> out{"PATH=/usr/bin:/bin", "LANG=C.UTF-8", "HOME=" + work.string(),
                               "TMPDIR=" + work.string()};
  for (const char* name :
       {"LD_LIBRARY_PATH", "ASAN_OPTIONS", "UBSAN_OPTIONS", "TSAN_OPTIONS", "LSAN_OPTIONS"}) {
    if (const char* value = std::getenv(name)) out.push_back(std::string(name) + "=" + value);
  }
  return out;
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> out;
  out.reserve(strings.size() + 1);
  for (std::string& text : strings) out.push_back(text.data());
  out.push_back(nullptr);
  return out;
}

// The data that the child needs, prepared before fork; after fork, only functions that acquire no
// lock are safe.
struct ChildPlan {
  const char* program;
  char* const* arguments;
  char* const* environment;
  const char* folder;
  int requests, progress, errors, answer;
  pid_t parent;
  const confine::Limits* limits;  // nullptr: the program sets them
  int niceness;
};

// Does not change the priority if the daemon already runs at this nice value or a greater one: if
// it runs as root, the call would raise the priority of its workers.
void give_way(int niceness) {
  if (::getpriority(PRIO_PROCESS, 0) >= niceness) return;
  if (::setpriority(PRIO_PROCESS, 0, niceness) != 0) errno = 0;  // not essential
}

[[noreturn]] void become_worker(const ChildPlan& plan) {
  ::dup2(plan.errors, 2);
  ::dup2(plan.requests, 0);
  ::dup2(plan.answer, 1);
  ::dup2(plan.progress, kProgressFd);
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != plan.parent) ::_exit(127);  // the daemon ended before prctl() took effect
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::signal(SIGPIPE, SIG_DFL);
  if (::chdir(plan.folder) != 0) confine::give_up(plan.folder);
  give_way(plan.niceness);
  if (plan.limits != nullptr) {
    if (const char* const step = confine::limit_use(*plan.limits)) confine::give_up(step);
  }
  ::close_range(kProgressFd + 1, ~0U, 0);
  ::execve(plan.program, plan.arguments, plan.environment);
  confine::give_up(plan.program);
}

std::string in_mib(std::int64_t bytes) {
  constexpr std::int64_t kMiB = 1 << 20;
  return bytes > 0 ? std::to_string((bytes + kMiB - 1) / kMiB) : "unlimited";
}

}  // namespace

std::vector<std::string> spec_options(const std::filesystem::path& spec_file) {
  return {"--spec=" + spec_file.string(), "--inputs=."};
}

std::vector<std::string> command_of(const Launch& what) {
  std::vector<std::string> out;
  if (what.confined) {
    out = {what.confine_program.string(), "--inputs=" + what.inputs.string(),
           "--work=" + what.work.string(), "--memory-mib=" + in_mib(what.limits.memory_bytes),
           "--file-mib=" + in_mib(what.limits.file_bytes)};
    if (!what.limits.needs_landlock) out.emplace_back(kAllowWithoutLandlock);
    if (what.limits.cpu_s > 0) out.push_back(fmt::format("--cpu-s={}", what.limits.cpu_s));
    out.emplace_back("--");
  }
  out.push_back(what.program.string());
  out.insert(out.end(), what.arguments.begin(), what.arguments.end());
  return out;
}

Result<ChildProcess> launch(const Launch& what) {
  HP_ASSIGN_OR_RETURN(Pipe progress, make_pipe());
  HP_ASSIGN_OR_RETURN(Pipe errors, make_pipe());
  HP_ASSIGN_OR_RETURN(Pipe answer, make_pipe());
  HP_ASSIGN_OR_RETURN(Pipe requests, make_stdin(what.is_asked));
  std::vector<std::string> arguments = command_of(what);
  std::vector<std::string> environment = make_environment(what.work);
  environment.insert(environment.end(), what.environment.begin(), what.environment.end());
  const std::vector<char*> argv = pointers(arguments), envp = pointers(environment);
  const ChildPlan plan{argv.front(),        argv.data(),
                       envp.data(),         what.inputs.c_str(),
                       requests.read.get(), progress.write.get(),
                       errors.write.get(),  answer.write.get(),
                       ::getpid(),          what.confined ? nullptr : &what.limits,
                       what.niceness};
  ChildProcess worker;
  worker.pid = ::fork();
  if (worker.pid == 0) become_worker(plan);
  if (worker.pid < 0) {
    return fail(
        Code::kInternal,
        fmt::format("cannot start a worker: {}; free memory, or end other processes on this "
                    "machine",
                    std::strerror(errno)),
        ErrorReason::WORKER_UNUSABLE);
  }
  ::setpgid(worker.pid, worker.pid);
  worker.handle = UniqueFd(static_cast<int>(::syscall(SYS_pidfd_open, worker.pid, 0)));
  worker.progress = std::move(progress.read);
  worker.errors = std::move(errors.read);
  worker.answer = std::move(answer.read);
  worker.requests = std::move(requests.write);
  return worker;
}

Result<std::string> check_confinement(const std::filesystem::path& confine_program,
                                      bool needs_landlock) {
  constexpr std::chrono::seconds kPatience{30};
  if (std::error_code ignored; !std::filesystem::exists(confine_program, ignored)) {
    return fail(Code::kFailedPrecondition,
                confine_program.string() +
                    ": this program does not exist; install it in the folder of hydroprintd");
  }
  std::vector<std::string> arguments{"--check"};
  if (!needs_landlock) arguments.emplace_back(kAllowWithoutLandlock);
  HP_ASSIGN_OR_RETURN(const ChildProcess check, launch({.program = confine_program,
                                                        .arguments = std::move(arguments),
                                                        .inputs = "/",
                                                        .confined = false}));
  const std::optional<int> ended = wait_for_end(check, kPatience);
  const int wait_status = ended ? *ended : kill_and_wait(check);
  std::string words;
  (void)drain(check.errors, words, 1 << 16);
  if (wait_status == 0) return last_line(words);
  return fail(Code::kFailedPrecondition, fmt::format("{} --check: {}", confine_program.string(),
                                                     words.empty() ? "failed" : last_line(words)));
}

void signal_group(const ChildProcess& worker, int signal) {
  if (worker.pid > 0) ::kill(-worker.pid, signal);
}

std::optional<int> wait_for_end(const ChildProcess& worker, std::chrono::milliseconds patience) {
  pollfd ended{worker.handle.get(), POLLIN, 0};
  ::poll(&ended, 1, static_cast<int>(patience.count()));
  int wait_status = 0;
  const pid_t pid = ::waitpid(worker.pid, &wait_status, WNOHANG);
  return pid == 0 ? std::nullopt : std::optional(wait_status);
}

int kill_and_wait(const ChildProcess& worker) {
  int wait_status = 0;
  if (worker.pid <= 0) return wait_status;
  signal_group(worker, SIGKILL);
  while (::waitpid(worker.pid, &wait_status, 0) < 0 && errno == EINTR) {
  }
  return wait_status;
}

bool drain(const UniqueFd& pipe, std::string& bytes, std::size_t most) {
  std::array<char, 16 << 10> buffer{};
  for (std::size_t read = 0; read < most;) {
    const ssize_t count = ::read(pipe.get(), buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno == EAGAIN;
    if (count == 0) return false;
    bytes.append(buffer.data(), static_cast<std::size_t>(count));
    read += static_cast<std::size_t>(count);
  }
  return true;
}

std::int64_t resident_bytes(const ChildProcess& worker) {
  std::ifstream file(fmt::format("/proc/{}/statm", worker.pid));
  std::int64_t total = 0, resident = 0;
  file >> total >> resident;
  return file ? resident * ::sysconf(_SC_PAGESIZE) : 0;
}

std::optional<std::int64_t> written_bytes(const ChildProcess& worker) {
  std::ifstream file(fmt::format("/proc/{}/io", worker.pid));
  std::optional<std::int64_t> most;
  std::string name;
  // Calls count in wchar, mapped memory in write_bytes, which tmpfs does not have.
  for (std::int64_t bytes = 0; file >> name >> bytes;)
    if (name == "wchar:" || name == "write_bytes:") most = std::max(most.value_or(0), bytes);
  return most;
}

}  // namespace hydroprint::daemon
