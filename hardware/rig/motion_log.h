#pragma once

#include "hardware/rig/rig_status.h"

namespace hydroprint::rig {

/// Writes on the status what becomes of each motion.
class MotionLog {
 public:
  /// @param status  outlives it
  explicit MotionLog(RigStatus& status) : status_(status) {}

  /// A motion starts; @return its number.
  std::uint64_t begin(Motion motion, TimePoint now, double position_mm);
  /// It is over, though perhaps not at rest.
  void end(MotionReport::Outcome outcome, Cause cause, int alarm_code);
  /// Where the axis was just seen.
  void see(const Sample& sample, bool at_rest);

  /// Number of the latest motion; 0: none yet.
  [[nodiscard]] std::uint64_t latest() const { return report_.number; }
  /// That of the motion to which samples belong now (its way to standstill included); 0: none.
  [[nodiscard]] std::uint64_t current() const { return open_ ? report_.number : 0; }

 private:
  RigStatus& status_;
  MotionReport report_;
  bool open_ = false;
};

}  // namespace hydroprint::rig
