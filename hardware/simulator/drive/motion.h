#pragma once

namespace hydroprint::simulated_drive {

/// Where something is and how fast it goes.
struct Kinematics {
  double x_mm = 0;
  double v_mm_per_s = 0;
};

/// Where a trajectory is to end.
struct Goal {
  enum class Kind { kPosition, kVelocity };
  Kind kind = Kind::kVelocity;
  double target_mm = 0;               ///< of kPosition, reached at rest
  double speed_mm_per_s = 0;          ///< of kPosition above 0; of kVelocity with its sign
  double acceleration_mm_per_s2 = 1;  ///< while the speed grows
  double deceleration_mm_per_s2 = 1;  ///< while it falls
};

/// Whether the goal is reached: nothing changes any more but x at constant velocity.
[[nodiscard]] bool is_reached(const Kinematics& now, const Goal& goal);

/// The trajectory of least time within the limits, `dt_s` later: pieces of constant acceleration,
/// each integrated exactly, so that the result does not depend on how time is cut.
[[nodiscard]] Kinematics advance(Kinematics now, const Goal& goal, double dt_s);

}  // namespace hydroprint::simulated_drive
