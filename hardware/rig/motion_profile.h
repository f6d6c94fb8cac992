#pragma once

namespace hydroprint::rig {

/// A move from rest to rest, as performed by the drive: acceleration, constant speed, and
/// deceleration at the same rate. A short move does not reach its nominal speed.
class Travel {
 public:
  /// @param speed_mm_per_s, acceleration_mm_per_s2  more than 0
  Travel(double from_mm, double to_mm, double speed_mm_per_s, double acceleration_mm_per_s2);

  /// Returns the position `t_s` after the start; before the start and after the end, that of the
  /// nearer end.
  [[nodiscard]] double position_mm(double t_s) const;
  [[nodiscard]] double duration_s() const { return 2 * ramp_s_ + cruise_s_; }
  /// Return the times, after the start of the move, at which the constant speed begins and ends.
  /// The two are equal if the move is too short to reach its nominal speed.
  [[nodiscard]] double cruise_begin_s() const { return ramp_s_; }
  [[nodiscard]] double cruise_end_s() const { return ramp_s_ + cruise_s_; }
  [[nodiscard]] double to_mm() const { return to_mm_; }
  /// Returns the highest speed reached.
  [[nodiscard]] double speed_mm_per_s() const { return acceleration_mm_per_s2_ * ramp_s_; }

 private:
  double from_mm_, to_mm_, acceleration_mm_per_s2_;
  double ramp_s_, cruise_s_;
};

}  // namespace hydroprint::rig
