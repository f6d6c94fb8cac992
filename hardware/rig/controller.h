#pragma once

#include <future>
#include <memory>
#include <vector>

#include "hardware/drive/drive.h"
#include "hardware/rig/command_queue.h"
#include "hardware/rig/config.h"
#include "hardware/rig/motion_supervisor.h"
#include "hardware/rig/rig_status.h"

namespace hydroprint::rig {

/// One rig. Its control loop runs at a fixed period, whether or not the drive responds. The loop
/// never waits for a caller, a log or a disk; it detects a lost link and reconnects automatically.
/// Thread-safe. Orders are executed one after the other. The future of an order is set when the
/// drive has accepted it (for arm and reset: when the drive reports the effect), or when the order
/// is refused. Reasons are those of errors.h, LIMIT_EXCEEDED and QUEUE_FULL, and STATE_FORBIDS
/// (kAborted) if the order waited too long or a stop followed it. motion() reports how a motion
/// continues and ends. An order never returns kUnavailable.
class Controller {
 public:
  /// Starts the controller, even without the drive. Returns the errors of check(config, profile).
  [[nodiscard]] static Result<std::unique_ptr<Controller>> make(const RigConfig& config,
                                                                drive::DriveProfile profile,
                                                                drive::Endpoint endpoint);
  /// Stops a motion, waits for standstill (at most as long as the drive's watchdog needs), and
  /// disables the torque.
  ~Controller();
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  std::future<Answer> arm();
  /// Disables the torque. The position of the axis is unknown afterwards.
  std::future<Answer> disarm();
  std::future<Answer> reset();
  std::future<Answer> home();
  std::future<Answer> move_to(double position_mm, double speed_mm_per_s);
  /// Moves at a speed of either sign as long as jog() is called again at least every kPresence_s.
  /// The axis stops within 500 ms of the last call, or before the soft limit.
  std::future<Answer> jog(double speed_mm_per_s);
  /// Performs each leg and its hold. The dip continues if the client disconnects.
  std::future<Answer> dip(std::vector<Leg> legs);

  /// Stops any motion. Returns immediately in every situation, is never refused and may be
  /// repeated. Earlier orders that have not started are refused.
  void stop() noexcept;

  [[nodiscard]] Snapshot snapshot() const;
  /// Returns why the drive does not respond, or must not be armed.
  [[nodiscard]] std::optional<Error> trouble() const;
  /// Returns the report of a motion; nullopt if the number does not exist or is too old.
  [[nodiscard]] std::optional<MotionReport> motion(std::uint64_t number) const;
  /// Returns samples by number, oldest first; old ones may have been overwritten
  /// (SampleRing::kSize).
  [[nodiscard]] std::vector<Sample> samples(std::uint64_t first, std::uint64_t last) const;

  [[nodiscard]] const RigConfig& config() const;
  [[nodiscard]] const drive::DriveProfile& profile() const;

 private:
  Controller();
  std::future<Answer> order(Event::Kind kind, Plan plan = {});

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydroprint::rig
