#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "sim/base/process/periodic_thread.h"

namespace hydroprint::daemon {

/// Notifies systemd (sd_notify). Does nothing if systemd did not start the daemon.
void notify_ready(const std::string& status);
void notify_stopping();

/// Feeds systemd's watchdog, if there is one, as long as the loop that monitors the drive makes
/// progress. That loop must never stall, even if everything else still responds.
class WatchdogFeeder {
 public:
  /// A function that returns the number of iterations of that loop since the start; nullopt without
  /// a drive.
  using Rounds = std::function<std::optional<std::uint64_t>()>;

  explicit WatchdogFeeder(Rounds rounds);

 private:
  void feed();

  Rounds rounds_;
  std::optional<std::uint64_t> before_;  // number of iterations at the last feeding
  // A separate thread, so that a disk that does not respond cannot stop the feeding.
  std::optional<PeriodicThread> thread_;
};

}  // namespace hydroprint::daemon
