#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace hydroprint::capture {

/// Ends a process that hangs: a separate thread calls `bites`, which must not return, if feed() is
/// not called for `patience`.
class Watchdog {
 public:
  Watchdog(std::chrono::duration<double> patience, std::function<void()> bites);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  void feed();

 private:
  void watch(const std::function<void()>& bites);

  const std::chrono::duration<double> patience_;
  std::mutex mutex_;
  std::condition_variable wakes_;
  std::chrono::steady_clock::time_point fed_ = std::chrono::steady_clock::now();
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace hydroprint::capture
