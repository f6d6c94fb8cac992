#pragma once

#include <optional>
#include <vector>

#include "hardware/drive/drive.h"
#include "hardware/rig/config.h"
#include "hardware/rig/motion_profile.h"
#include "hardware/rig/samples.h"
#include "hardware/rig/state.h"

namespace hydroprint::rig {

/// One way at constant speed, and how long to stay at its end.
struct Leg {
  double target_mm = 0;
  double speed_mm_per_s = 0;
  double hold_s = 0;
};

/// What a motion is to do.
struct Plan {
  Motion motion = Motion::kNone;
  std::vector<Leg> legs = {};  ///< of a move (one) and of a dip
  double jog_mm_per_s = 0;     ///< of a jog; its sign is its direction
};

/// Refuses a plan that leaves the soft limits or is too fast (check_target, check_speed), a move
/// without its leg, a dip without any or with a hold that is no time.
[[nodiscard]] Status check(const RigConfig& config, const Plan& plan);

/// One motion under way: told what the drive shows, it says what is next. It knows no drive.
class MotionSupervisor {
 public:
  /// @param plan  checked
  MotionSupervisor(const RigConfig& config, const drive::DriveProfile& profile, Plan plan,
                   TimePoint start, double position_mm);

  struct Advice {
    std::optional<Event::Kind> event;  ///< for the state machine
    std::optional<Leg> next;           ///< command this move now, then call begin_leg()
  };
  /// Looks at a clean sample of the drive.
  [[nodiscard]] Advice look(const drive::DriveState& drive);
  /// The leg's move was commanded, at this time.
  void begin_leg(TimePoint now);
  /// Somebody holds the jog at this time, and wants this speed.
  void hold_jog(TimePoint now, double speed_mm_per_s);

  /// Fills in what of a sample is the motion's: leg, where it should be, whether it cruises.
  void note(Sample& sample) const;

  [[nodiscard]] const Plan& plan() const { return plan_; }

 private:
  [[nodiscard]] Advice look_at_home(const drive::DriveState& drive);
  [[nodiscard]] Advice look_at_jog(const drive::DriveState& drive) const;
  [[nodiscard]] Advice look_at_leg(const drive::DriveState& drive);
  [[nodiscard]] double since_leg_s(TimePoint time) const;

  RigConfig config_;
  drive::DriveProfile profile_;
  Plan plan_;
  TimePoint start_;
  double start_mm_;
  bool seen_moving_ = false;  // of homing
  TimePoint held_;            // of a jog
  std::size_t leg_ = 0;
  double from_mm_;
  std::optional<Travel> travel_;  // of a leg that began
  TimePoint leg_start_;
  std::optional<TimePoint> arrived_;
};

}  // namespace hydroprint::rig
