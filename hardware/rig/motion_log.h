#pragma once

#include "hardware/rig/rig_status.h"

namespace hydroprint::rig {

/// Writes the report of each motion to the status.
class MotionLog {
 public:
  /// @param status  must outlive this object
  explicit MotionLog(RigStatus& status) : status_(status) {}

  /// Records the start of a motion and returns its number.
  std::uint64_t begin(Motion motion, TimePoint now, double position_mm);
  /// Records the end of the motion, perhaps before standstill.
  void end(MotionReport::Outcome outcome, Cause cause, int alarm_code);
  /// Records a sample of the axis.
  void see(const Sample& sample, bool at_rest);

  /// Returns the number of the latest motion; 0: none yet.
  [[nodiscard]] std::uint64_t latest() const { return report_.number; }
  /// Returns the number of the motion to which new samples belong; 0 once the axis is at
  /// standstill.
  [[nodiscard]] std::uint64_t current() const { return open_ ? report_.number : 0; }

 private:
  RigStatus& status_;
  MotionReport report_;
  bool open_ = false;
};

}  // namespace hydroprint::rig
