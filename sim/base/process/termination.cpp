#include "sim/base/process/termination.h"

#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <utility>

#include "sim/base/result.h"

namespace hydroprint::worker {
namespace {

constexpr long kGrace_ns = 700'000'000;
// Wakes the signal thread when the process ends without a signal.
constexpr int kWake = SIGUSR1;

sigset_t watched() {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    sigaction(number, nullptr, &action);
    // Signals that the parent set to be ignored (nohup, background jobs of a shell) stay ignored.
    if (action.sa_handler != SIG_IGN) sigaddset(&set, number);
  }
  sigaddset(&set, kWake);
  return set;
}

}  // namespace

Termination::Termination(std::function<void()> last_words) : last_words_(std::move(last_words)) {
  // A closed pipe, or a file beyond the size limit, must only fail the write in question.
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
  const sigset_t set = watched();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  thread_ = std::thread([this] { listen(); });
}

Termination::~Termination() {
  stop_ = true;
  pthread_kill(thread_.native_handle(), kWake);
  thread_.join();
}

void Termination::decide() {
  By decided = By::kNobody;
  decided_.compare_exchange_strong(decided, By::kMain);
  while (decided == By::kSignal) pause();
}

void Termination::set_cleanup(std::function<void()> cleanup) {
  const std::lock_guard lock(mutex_);
  cleanup_ = std::move(cleanup);
}

void Termination::listen() {
  const sigset_t set = watched();
  int number = 0;
  do {
    sigwait(&set, &number);
    if (stop_) return;
  } while (number == kWake);
  requested_ = true;
  const timespec grace{0, kGrace_ns};
  sigtimedwait(&set, nullptr, &grace);
  By decided = By::kNobody;
  if (stop_ || !decided_.compare_exchange_strong(decided, By::kSignal)) return;
  const std::lock_guard lock(mutex_);
  if (cleanup_) cleanup_();
  last_words_();
  _exit(static_cast<int>(ExitStatus::kCancelled));
}

}  // namespace hydroprint::worker
