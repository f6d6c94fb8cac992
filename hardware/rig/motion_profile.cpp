#include "hardware/rig/motion_profile.h"

#include <algorithm>
#include <cmath>

namespace hydroprint::rig {

Travel::Travel(double from_mm, double to_mm, double speed_mm_per_s, double acceleration_mm_per_s2)
    : from_mm_(from_mm), to_mm_(to_mm), acceleration_mm_per_s2_(acceleration_mm_per_s2) {
  const double length_mm = std::abs(to_mm - from_mm);
  ramp_s_ = std::min(speed_mm_per_s / acceleration_mm_per_s2,
                     std::sqrt(length_mm / acceleration_mm_per_s2));
  const double top_mm_per_s = acceleration_mm_per_s2 * ramp_s_;
  const double cruise_mm = length_mm - top_mm_per_s * ramp_s_;
  cruise_s_ = top_mm_per_s > 0 ? std::max(0.0, cruise_mm / top_mm_per_s) : 0;
}

double Travel::position_mm(double t_s) const {
  // The distance up to t is the area of a speed trapezoid that is cut off at t.
  const double t = std::clamp(t_s, 0.0, duration_s());
  const double ramp = std::min(t, ramp_s_);
  const double cruise = std::clamp(t - ramp_s_, 0.0, cruise_s_);
  const double brake = std::max(0.0, t - ramp_s_ - cruise_s_);
  const double way_mm = acceleration_mm_per_s2_ *
                        (ramp * ramp / 2 + ramp_s_ * cruise + brake * (ramp_s_ - brake / 2));
  return from_mm_ + std::copysign(way_mm, to_mm_ - from_mm_);
}

}  // namespace hydroprint::rig
