#include "daemon/platform/systemd_notify.h"

#include <systemd/sd-daemon.h>

#include <chrono>
#include <utility>

namespace hydroprint::daemon {

// The return value is ignored: it only shows whether there is a notification socket.
void notify_ready(const std::string& status) {
  (void)sd_notify(0, ("READY=1\nSTATUS=" + status).c_str());
}

void notify_stopping() { (void)sd_notify(0, "STOPPING=1\nSTATUS=bringing the axis to rest"); }

WatchdogFeeder::WatchdogFeeder(Rounds rounds) : rounds_(std::move(rounds)) {
  std::uint64_t limit_us = 0;
  if (sd_watchdog_enabled(0, &limit_us) <= 0) return;
  thread_.emplace(std::chrono::microseconds(limit_us / 4), [this] { feed(); });
}

void WatchdogFeeder::feed() {
  const auto now = rounds_();
  if (!now || now != std::exchange(before_, now)) (void)sd_notify(0, "WATCHDOG=1");
}

}  // namespace hydroprint::daemon
