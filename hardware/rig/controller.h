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

/// One rig. Its owner thread looks at the drive at a fixed period, whether or not the drive
/// answers, and never waits for a caller, a log or a disk; it loses and finds the drive again by
/// itself.
///
/// Any thread may call anything, at any time. Orders are carried out one after the other; the
/// future of an order is there when the drive took it (arm and reset: when the drive shows it), or
/// it was refused, by the reasons of errors.h, LIMIT_EXCEEDED, QUEUE_FULL, or kAborted if it came
/// too late, or a stop came after it. What then becomes of a motion stands in motion(). No order is
/// ever answered with kUnavailable.
class Controller {
 public:
  /// Starts it; the drive need not be there. Refuses what check(config, profile) refuses.
  [[nodiscard]] static Result<std::unique_ptr<Controller>> make(const RigConfig& config,
                                                                drive::DriveProfile profile,
                                                                drive::Endpoint endpoint);
  /// Stops a motion, waits for standstill (as long as the drive's watchdog needs at most), and
  /// takes the torque away.
  ~Controller();
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  std::future<Answer> arm();
  /// Takes the torque away; where the axis is, is not known afterwards.
  std::future<Answer> disarm();
  std::future<Answer> reset();
  std::future<Answer> home();
  std::future<Answer> move_to(double position_mm, double speed_mm_per_s);
  /// Moves at a speed of either sign for as long as this is called again at least every
  /// kPresence_s; at rest within 500 ms of the last call, or before the soft limit.
  std::future<Answer> jog(double speed_mm_per_s);
  /// Goes each leg and holds; nobody need be there.
  std::future<Answer> dip(std::vector<Leg> legs);

  /// Stops any motion. Returns at once, whatever hangs; never refused; again does no harm. Orders
  /// given before it and not carried out yet are refused.
  void stop() noexcept;

  [[nodiscard]] Snapshot snapshot() const;
  /// Why the drive does not answer, or must not be armed.
  [[nodiscard]] std::optional<Error> trouble() const;
  /// What became of a motion; none if there was none of that number, or many since.
  [[nodiscard]] std::optional<MotionReport> motion(std::uint64_t number) const;
  /// Samples by their numbers, oldest first; the older ones may be gone (SampleRing::kSize).
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
