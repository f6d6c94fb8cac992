#include "tests/support/process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/content.h"

namespace hydroprint::testing {
namespace {

/// Opens a file as a given descriptor. Runs in the child, where only a few calls are safe.
void open_as(int number, const char* path) {
  const int file = ::open(path, O_WRONLY | O_CREAT | O_APPEND, 0600);
  if (file == number) return;
  ::dup2(file, number);
  ::close(file);
}

}  // namespace

Process::Process(std::vector<std::string> arguments, const ProcessOptions& options) {
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const std::string out = folder_.path() / "out";
  const std::string err = folder_.path() / "err";
  start_ = Clock::now();
  pid_ = ::fork();
  if (pid_ != 0) return;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // the program is killed when the test dies
  open_as(STDOUT_FILENO, out.c_str());
  open_as(STDERR_FILENO, err.c_str());
  if (options.close_stdout) ::close(STDOUT_FILENO);
  for (const auto& [number, path] : options.files) open_as(number, path.c_str());
  for (const auto& [number, ours] : options.inherited) {
    ::dup2(ours, number);
    ::fcntl(number, F_SETFD, 0);  // if ours == number, dup2 keeps close-on-exec
  }
  for (const auto& [resource, value] : options.limits) {
    const rlimit limit{value, value};
    ::setrlimit(resource, &limit);
  }
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

Process::~Process() {
  if (!running()) return;
  signal(SIGKILL);
  wait();
}

void Process::signal(int number) const { ::kill(pid_, number); }

bool Process::running() {
  int status = 0;
  if (!wait_status_ && ::waitpid(pid_, &status, WNOHANG) == pid_) wait_status_ = status;
  return !wait_status_;
}

std::string Process::out() const { return content(folder_.path() / "out"); }

Ended Process::wait() {
  int status = 0;
  if (!wait_status_) {
    ::waitpid(pid_, &status, 0);
    wait_status_ = status;
  }
  Ended ended;
  if (WIFEXITED(*wait_status_)) ended.status = WEXITSTATUS(*wait_status_);
  if (WIFSIGNALED(*wait_status_)) ended.signal = WTERMSIG(*wait_status_);
  ended.out = out();
  ended.err = content(folder_.path() / "err");
  ended.seconds = seconds_since(start_);
  return ended;
}

Ended run(std::vector<std::string> arguments, const ProcessOptions& options) {
  return Process(std::move(arguments), options).wait();
}

}  // namespace hydroprint::testing
