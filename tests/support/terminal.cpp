#include "tests/support/terminal.h"

#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <thread>

namespace hydroprint::testing {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

}  // namespace

Terminal::Terminal(std::vector<std::string> arguments) {
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  winsize size{};
  size.ws_row = 40;
  size.ws_col = 200;
  pid_ = ::forkpty(&master_, nullptr, nullptr, &size);
  if (pid_ != 0) return;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

Terminal::~Terminal() {
  if (!status_) {
    ::kill(pid_, SIGKILL);
    wait();
  }
  ::close(master_);
}

void Terminal::type(const std::string& keys) const {
  [[maybe_unused]] const auto written = ::write(master_, keys.data(), keys.size());
}

void Terminal::hold(const std::string& key, std::chrono::milliseconds time,
                    std::chrono::milliseconds repeat) {
  for (const auto end = Clock::now() + time; Clock::now() < end;) {
    type(key);
    look(0ms);
    std::this_thread::sleep_for(repeat);
  }
}

void Terminal::look(std::chrono::milliseconds limit) {
  pollfd input{master_, POLLIN, 0};
  if (::poll(&input, 1, static_cast<int>(limit.count())) <= 0) return;
  std::array<char, 4096> bytes{};
  const auto count = ::read(master_, bytes.data(), bytes.size());
  if (count > 0) screen_.append(bytes.data(), static_cast<std::size_t>(count));
  if (count <= 0)
    std::this_thread::sleep_for(limit);  // the program has ended; there is no more output
}

bool Terminal::shows(const std::string& words, std::chrono::milliseconds limit) {
  for (const auto end = Clock::now() + limit; Clock::now() < end; look(20ms)) {
    const auto found = screen_.find(words, seen_);
    if (found == std::string::npos) continue;
    seen_ = found + words.size();
    return true;
  }
  return false;
}

int Terminal::wait(std::chrono::seconds limit) {
  int status = 0;
  for (const auto end = Clock::now() + limit; !status_ && Clock::now() < end; look(20ms))
    if (::waitpid(pid_, &status, WNOHANG) == pid_) status_ = status;
  look(0ms);
  if (!status_ || !WIFEXITED(*status_)) return -1;
  return WEXITSTATUS(*status_);
}

bool Terminal::is_cooked() const {
  termios settings{};
  ::tcgetattr(master_, &settings);
  return (settings.c_lflag & ICANON) != 0 && (settings.c_lflag & ECHO) != 0;
}

}  // namespace hydroprint::testing
