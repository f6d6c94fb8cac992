#include "hardware/capture/watchdog.h"

#include <utility>

namespace hydroprint::capture {

using Clock = std::chrono::steady_clock;

Watchdog::Watchdog(std::chrono::duration<double> patience, std::function<void()> bites)
    : patience_(patience), thread_([this, b = std::move(bites)] { watch(b); }) {}

Watchdog::~Watchdog() {
  {
    const std::scoped_lock lock(mutex_);
    ends_ = true;
  }
  wakes_.notify_all();
  thread_.join();
}

void Watchdog::feed() {
  const std::scoped_lock lock(mutex_);
  fed_ = Clock::now();
}

void Watchdog::watch(const std::function<void()>& bites) {
  std::unique_lock lock(mutex_);
  while (!ends_) {
    const auto due = fed_ + std::chrono::duration_cast<Clock::duration>(patience_);
    if (Clock::now() >= due) {
      lock.unlock();
      bites();
      return;
    }
    wakes_.wait_until(lock, due);
  }
}

}  // namespace hydroprint::capture
