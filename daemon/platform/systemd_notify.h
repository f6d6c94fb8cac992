#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "sim/base/process/periodic_thread.h"

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

 private:
  void feed();

  Rounds rounds_;
  std::optional<std::uint64_t> before_;  // rounds when it was last fed
  // A thread of its own: a disk that hangs must not stop it.
  std::optional<PeriodicThread> thread_;
};

}  // namespace hydroprint::daemon
