#include "daemon/service_manager.h"

#include <systemd/sd-daemon.h>

#include <chrono>
#include <utility>

namespace hydroprint::daemon {

// Its answer only says whether somebody listens.
void notify_ready(const std::string& status) {
  (void)sd_notify(0, ("READY=1\nSTATUS=" + status).c_str());
}

void notify_stopping() { (void)sd_notify(0, "STOPPING=1\nSTATUS=bringing the axis to rest"); }

WatchdogFeeder::WatchdogFeeder(Rounds rounds) : rounds_(std::move(rounds)) {
  std::uint64_t limit_us = 0;
  if (sd_watchdog_enabled(0, &limit_us) <= 0) return;
  thread_ = std::thread([this, limit_us] { feed(limit_us / 4); });
}

WatchdogFeeder::~WatchdogFeeder() {
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void WatchdogFeeder::feed(std::uint64_t period_us) {
  std::optional<std::uint64_t> before;
  std::unique_lock lock(mutex_);
  while (!end_) {
    const auto now = rounds_();
    if (!now || now != std::exchange(before, now)) (void)sd_notify(0, "WATCHDOG=1");
    changed_.wait_for(lock, std::chrono::microseconds(period_us));
  }
}

}  // namespace hydroprint::daemon
