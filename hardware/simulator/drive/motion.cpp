#include "hardware/simulator/drive/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hydroprint::simulated_drive {
namespace {

constexpr double kTolerance_mm = 1e-9;
constexpr double kUnlimited_s = std::numeric_limits<double>::infinity();

/// Constant acceleration for `duration_s`. Afterwards the velocity is exactly `end_v` (no drift)
/// and, in the last piece, the position is exactly the target.
struct Piece {
  double acceleration = 0;
  double duration_s = kUnlimited_s;
  double end_v = 0;
  bool lands = false;
};

Piece ramp(double from_v, double to_v, double rate) {
  const double sign = to_v > from_v ? 1 : -1;
  return {sign * rate, std::abs(to_v - from_v) / rate, to_v, false};
}

Piece towards_velocity(double v, const Goal& goal) {
  const double wanted = goal.speed_mm_per_s;
  if (v == wanted) return {0, kUnlimited_s, v, false};
  if (v * wanted < 0) return ramp(v, 0, goal.deceleration_mm_per_s2);
  const bool grows = std::abs(wanted) > std::abs(v);
  return ramp(v, wanted, grows ? goal.acceleration_mm_per_s2 : goal.deceleration_mm_per_s2);
}

// In the direction of the target: `gap` > 0 is the remaining distance, `speed` >= 0.
Piece towards_gap(double gap, double speed, const Goal& goal) {
  const double braking = goal.deceleration_mm_per_s2;
  const double stop_gap = speed * speed / (2 * braking);
  if (stop_gap > gap - kTolerance_mm) {
    Piece piece = ramp(speed, 0, braking);
    piece.lands = stop_gap < gap + kTolerance_mm;
    return piece;
  }
  if (speed > goal.speed_mm_per_s) return ramp(speed, goal.speed_mm_per_s, braking);
  if (speed == goal.speed_mm_per_s) return {0, (gap - stop_gap) / speed, speed, false};
  const double gain = goal.acceleration_mm_per_s2;
  // The speed at which acceleration from here meets the braking parabola that ends at the target.
  const double peak =
      std::sqrt((2 * gap * gain * braking + speed * speed * braking) / (gain + braking));
  return ramp(speed, std::min(peak, goal.speed_mm_per_s), gain);
}

Piece towards_position(const Kinematics& now, const Goal& goal) {
  const double gap = goal.target_mm - now.x_mm;
  const double sign = gap < 0 ? -1 : 1;
  const double speed = sign * now.v_mm_per_s;
  if (speed < 0) return ramp(now.v_mm_per_s, 0, goal.deceleration_mm_per_s2);
  Piece piece = towards_gap(std::abs(gap), speed, goal);
  piece.acceleration *= sign;
  piece.end_v *= sign;
  return piece;
}

}  // namespace

bool is_reached(const Kinematics& now, const Goal& goal) {
  if (goal.kind == Goal::Kind::kVelocity) return now.v_mm_per_s == goal.speed_mm_per_s;
  return now.v_mm_per_s == 0 && now.x_mm == goal.target_mm;
}

Kinematics advance(Kinematics now, const Goal& goal, double dt_s) {
  while (dt_s > 0) {
    const bool to_position = goal.kind == Goal::Kind::kPosition;
    if (to_position && is_reached(now, goal)) return now;
    const Piece piece =
        to_position ? towards_position(now, goal) : towards_velocity(now.v_mm_per_s, goal);
    const double t = std::min(dt_s, piece.duration_s);
    now.x_mm += now.v_mm_per_s * t + piece.acceleration * t * t / 2;
    now.v_mm_per_s += piece.acceleration * t;
    if (t == piece.duration_s) {
      now.v_mm_per_s = piece.end_v;
      if (piece.lands) now.x_mm = goal.target_mm;
    }
    dt_s -= t;
  }
  return now;
}

}  // namespace hydroprint::simulated_drive
