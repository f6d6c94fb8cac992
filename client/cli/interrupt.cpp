#include "client/cli/interrupt.h"

#include <unistd.h>

#include "sim/base/result.h"

namespace hydroprint::cli {
namespace {

constexpr int kEnd = SIGUSR1;  // what the destructor sends to the listener

}  // namespace

Interrupt::Interrupt() {
  sigemptyset(&signals_);
  for (const int signal : {SIGINT, SIGTERM, kEnd}) sigaddset(&signals_, signal);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  listener_ = std::thread([this] { listen(); });
}

Interrupt::~Interrupt() {
  pthread_kill(listener_.native_handle(), kEnd);
  listener_.join();
}

void Interrupt::listen() {
  for (int signal = 0; sigwait(&signals_, &signal) == 0 && signal != kEnd;) {
    if (stop_.stop_requested()) _exit(static_cast<int>(ExitStatus::kCancelled));
    stop_.request_stop();
  }
}

}  // namespace hydroprint::cli
