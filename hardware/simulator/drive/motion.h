#pragma once

namespace hydroprint::simulated_drive {

/// Position and velocity.
struct Kinematics {
  double x_mm = 0;
  double v_mm_per_s = 0;
};

/// The goal of a trajectory.
struct Goal {
  enum class Kind { kPosition, kVelocity };
  Kind kind = Kind::kVelocity;
  double target_mm = 0;               ///< target of kPosition, reached at rest
  double speed_mm_per_s = 0;          ///< for kPosition, above 0; for kVelocity, with its sign
  double acceleration_mm_per_s2 = 1;  ///< while the speed increases
  double deceleration_mm_per_s2 = 1;  ///< while the speed decreases
};

/// Returns whether the goal is reached. Afterwards only x changes, at constant velocity.
[[nodiscard]] bool is_reached(const Kinematics& now, const Goal& goal);

/// Advances the time-optimal trajectory within the limits by `dt_s`. The trajectory consists of
/// pieces of constant acceleration, each integrated exactly, so the result does not depend on the
/// time steps.
[[nodiscard]] Kinematics advance(Kinematics now, const Goal& goal, double dt_s);

}  // namespace hydroprint::simulated_drive
