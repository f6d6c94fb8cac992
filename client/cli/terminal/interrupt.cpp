#include "client/cli/terminal/interrupt.h"

#include <unistd.h>

#include "client/cli/terminal/terminal.h"
#include "sim/base/result.h"

namespace hydroprint::cli {
namespace {

constexpr int kEnd = SIGUSR1;  // sent by the destructor to the listener

[[noreturn]] void leave(int status) {
  restore_terminal();
  _exit(status);
}

// Returns whether the signal is ignored, like SIGHUP under nohup. sigwait() would receive it
// nevertheless.
bool is_ignored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

Interrupt::Interrupt() {
  sigemptyset(&signals_);
  for (const int signal : {SIGINT, SIGTERM, kEnd}) sigaddset(&signals_, signal);
  if (!is_ignored(SIGHUP)) sigaddset(&signals_, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  listener_ = std::thread([this] { listen(); });
}

Interrupt::~Interrupt() {
  pthread_kill(listener_.native_handle(), kEnd);
  listener_.join();
}

void Interrupt::listen() {
  for (int signal = 0; sigwait(&signals_, &signal) == 0 && signal != kEnd;) {
    if (signal == SIGHUP) leave(128 + SIGHUP);  // the terminal was closed; jobs continue
    if (stop_.stop_requested()) leave(static_cast<int>(ExitStatus::kCancelled));
    stop_.request_stop();
  }
}

}  // namespace hydroprint::cli
