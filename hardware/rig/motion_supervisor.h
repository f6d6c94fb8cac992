#pragma once

#include <optional>
#include <vector>

#include "hardware/drive/drive.h"
#include "hardware/rig/config.h"
#include "hardware/rig/motion_profile.h"
#include "hardware/rig/observe.h"
#include "hardware/rig/samples.h"
#include "hardware/rig/state.h"

namespace hydroprint::rig {

/// A move at constant speed and the hold at its end.
struct Leg {
  double target_mm = 0;
  double speed_mm_per_s = 0;
  double hold_s = 0;
};

/// The parameters of a motion.
struct Plan {
  Motion motion = Motion::kNone;
  std::vector<Leg> legs = {};  ///< exactly one for a move, one or more for a dip, otherwise empty
  double jog_mm_per_s = 0;     ///< speed of a jog; the sign is the direction
};

/// Returns an error for a plan that leaves the soft limits or is too fast (check_target,
/// check_speed), a move without exactly one leg, a dip without legs, and an invalid hold time.
[[nodiscard]] Status check(const RigConfig& config, const Plan& plan);

/// One motion in progress: processes samples of the drive and returns the next action. Has no
/// access to the drive.
class MotionSupervisor {
 public:
  /// @param plan  has passed check()
  MotionSupervisor(const RigConfig& config, const drive::DriveProfile& profile, Plan plan,
                   TimePoint start, double position_mm);

  struct Advice {
    std::optional<Event> event;  ///< event for the state machine
    std::optional<Leg> next;     ///< if set, call begin_leg() and send this move now
  };
  /// Processes a valid sample of the drive.
  [[nodiscard]] Advice look(const drive::DriveState& drive);
  /// Records the time at which the leg's move is sent.
  void begin_leg(TimePoint now);
  /// Records that the jog was requested again at `asked`, and its speed, ordered `now`.
  void hold_jog(TimePoint asked, TimePoint now, double speed_mm_per_s);
  /// Returns what the axis is ordered to do now, for observe().
  [[nodiscard]] AxisOrder order() const;

  /// Fills in the fields of a sample that depend on the motion: leg, expected position, and whether
  /// the speed should be constant.
  void note(Sample& sample) const;

  [[nodiscard]] const Plan& plan() const { return plan_; }

 private:
  [[nodiscard]] Advice look_at_home(const drive::DriveState& drive);
  void follow_home(const drive::DriveState& drive);
  [[nodiscard]] Advice look_at_jog(const drive::DriveState& drive) const;
  [[nodiscard]] Advice look_at_leg(const drive::DriveState& drive);
  [[nodiscard]] double since_leg_s(TimePoint time) const;

  RigConfig config_;
  drive::DriveProfile profile_;
  Plan plan_;
  TimePoint start_;
  double start_mm_;
  // For homing: the axis was seen moving; the home switch or the homed bit was seen to change; the
  // way so far, without steps that set the position to zero; the sample before.
  bool seen_moving_ = false, seen_home_ = false;
  double way_mm_ = 0;
  std::optional<drive::DriveState> before_;
  TimePoint held_;  // for a jog: time of the last request
  AxisOrder jog_;   // for a jog: its latest speed
  std::size_t leg_ = 0;
  double from_mm_;
  std::optional<Travel> travel_;  // for a leg that has begun
  TimePoint leg_start_;
  std::optional<TimePoint> arrived_;
};

}  // namespace hydroprint::rig
