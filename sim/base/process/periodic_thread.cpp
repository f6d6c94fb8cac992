#include "sim/base/process/periodic_thread.h"

#include <utility>

namespace hydroprint {

PeriodicThread::PeriodicThread(std::chrono::nanoseconds period, std::function<void()> task)
    : period_(period), thread_([this, task = std::move(task)] { run(task); }) {}

PeriodicThread::~PeriodicThread() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  stopped_.notify_one();
  thread_.join();
}

void PeriodicThread::run(const std::function<void()>& task) {
  std::unique_lock lock(mutex_);
  while (!stop_) {
    lock.unlock();
    task();
    lock.lock();
    stopped_.wait_for(lock, period_, [this] { return stop_; });
  }
}

}  // namespace hydroprint
