#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace hydroprint::daemon {

/// What systemd is told (sd_notify); nothing happens where nobody asked to be told.
void notify_ready(const std::string& status);
void notify_stopping();

/// Feeds systemd's watchdog, if there is one, for as long as the loop that looks at the drive goes
/// round: what hangs while everything else answers is the one thing that must not.
class WatchdogFeeder {
 public:
  /// Rounds of that loop since the start; none: there is no drive to look at.
  using Rounds = std::function<std::optional<std::uint64_t>()>;

  explicit WatchdogFeeder(Rounds rounds);
  ~WatchdogFeeder();
  WatchdogFeeder(const WatchdogFeeder&) = delete;
  WatchdogFeeder& operator=(const WatchdogFeeder&) = delete;

 private:
  void feed(std::uint64_t period_us);

  Rounds rounds_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool end_ = false;
  std::thread thread_;  // of its own: a disk that hangs keeps nothing from being fed
};

}  // namespace hydroprint::daemon
