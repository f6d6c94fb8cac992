#pragma once

#include <atomic>
#include <chrono>
#include <thread>

#include "hardware/drive/stop_line.h"
#include "hardware/rig/samples.h"

namespace hydroprint::rig {

/// The stop's own path: a thread that does nothing else and has its own connection to the drive
/// (TCP) or goes first on the line (RTU). It also stops the drive by itself when the owner of the
/// drive, expected to be looking at a motion, has not had a clean look for kStale_s.
class StopChannel {
 public:
  /// For so long it repeats a stop that is not confirmed. Not longer: each try is something that
  /// the drive hears, and only a drive that hears nothing is stopped by its watchdog.
  static constexpr std::chrono::milliseconds kPatience{150};

  explicit StopChannel(const drive::Drive& drive);
  ~StopChannel();
  StopChannel(const StopChannel&) = delete;
  StopChannel& operator=(const StopChannel&) = delete;

  /// Has the drive stopped. Any thread; returns at once, whatever hangs.
  void stop() noexcept;
  /// A stop is still on its way to the drive: what is ordered now would be stopped by it.
  [[nodiscard]] bool is_busy() const noexcept { return stop_ || stopping_; }
  /// Has it connect ahead of time. Returns at once.
  void prepare() noexcept;

  /// By the owner: a motion is (or is not) under way, last seen clean then.
  void watch(bool in_motion, TimePoint clean) noexcept;
  /// True once after it stopped the drive because the owner did not look.
  [[nodiscard]] bool take_trip() noexcept { return tripped_.exchange(false); }

 private:
  void run();
  [[nodiscard]] bool owner_is_late() const;
  void ring() noexcept;

  drive::StopLine line_;
  int bell_;  // eventfd
  std::atomic<bool> stop_{false}, stopping_{false}, prepare_{false}, tripped_{false}, end_{false};
  std::atomic<bool> in_motion_{false};
  std::atomic<TimePoint::rep> clean_{0};
  std::thread thread_;
};

}  // namespace hydroprint::rig
