#pragma once

#include <atomic>
#include <chrono>
#include <thread>

#include "hardware/drive/stop_line.h"
#include "hardware/rig/samples.h"

namespace hydroprint::rig {

/// A separate path for stopping: a thread with no other task and its own connection to the drive
/// (TCP) or precedence on the line (RTU). It also stops the drive if the control loop, during a
/// motion, has had no valid poll for kStale_s.
class StopChannel {
 public:
  /// Time for which an unconfirmed stop is repeated. It must not be longer, because every attempt
  /// feeds the drive's watchdog, which acts only on silence.
  static constexpr std::chrono::milliseconds kPatience{150};

  explicit StopChannel(const drive::Drive& drive);
  ~StopChannel();
  StopChannel(const StopChannel&) = delete;
  StopChannel& operator=(const StopChannel&) = delete;

  /// Stops the drive. Thread-safe; returns immediately in every situation.
  void stop() noexcept;
  /// Returns whether a stop is still being sent to the drive. That stop would also end a motion
  /// that is started now.
  [[nodiscard]] bool is_busy() const noexcept { return stop_ || stopping_; }
  /// Returns when the drive last acknowledged a stop of this channel; the epoch: never.
  [[nodiscard]] TimePoint acknowledged() const noexcept {
    return TimePoint(TimePoint::duration(acknowledged_));
  }
  /// Sends no stops for this long: the drive does not obey them, but each one would keep its
  /// watchdog from stopping the axis.
  void keep_silent(std::chrono::duration<double> silence) noexcept;
  /// Has the thread connect in advance. Returns immediately.
  void prepare() noexcept;

  /// For the control loop: sets whether a motion is in progress, and the time of the last valid
  /// poll.
  void watch(bool in_motion, TimePoint clean) noexcept;
  /// Returns true once after the channel has stopped the drive because the control loop was late.
  [[nodiscard]] bool consume_trip() noexcept { return tripped_.exchange(false); }

 private:
  void run();
  [[nodiscard]] bool owner_is_late() const;
  void send_stop();
  void ring() noexcept;

  drive::StopLine line_;
  int wake_event_;  // eventfd
  std::atomic<bool> stop_{false}, stopping_{false}, prepare_{false}, tripped_{false}, end_{false};
  std::atomic<bool> in_motion_{false};
  std::atomic<TimePoint::rep> clean_{0}, acknowledged_{0}, silent_until_{0};
  std::thread thread_;
};

}  // namespace hydroprint::rig
