#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace hydroprint {

/// Calls a function periodically on its own thread: immediately, then one period after each return.
/// The destructor waits for a call in progress. There are no calls after it.
class PeriodicThread {
 public:
  /// @param task  must not throw
  PeriodicThread(std::chrono::nanoseconds period, std::function<void()> task);
  ~PeriodicThread();
  PeriodicThread(const PeriodicThread&) = delete;
  PeriodicThread& operator=(const PeriodicThread&) = delete;

 private:
  void run(const std::function<void()>& task);

  const std::chrono::nanoseconds period_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stop_ = false;
  std::thread thread_;  // last member, because it uses the others
};

}  // namespace hydroprint
