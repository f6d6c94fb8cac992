#pragma once

#include <optional>
#include <vector>

#include "hardware/drive/drive.h"
#include "hardware/rig/motion_supervisor.h"
#include "hardware/rig/observe.h"

namespace hydroprint::rig {

/// Keeps the latest samples and what the axis is ordered to do, for observe(). Has no access to the
/// drive.
class AxisObserver {
 public:
  /// @param config, profile  must outlive this object
  AxisObserver(const RigConfig& config, const drive::DriveProfile& profile);

  /// Adds a valid sample of the drive and returns the fault that the samples show.
  /// @param condition  after the sample's event
  /// @param supervisor  of the motion in progress, or nullptr
  /// @param stopped  when the drive acknowledged the stop of the current STOPPING
  [[nodiscard]] std::optional<Cause> look(const Condition& condition,
                                          const MotionSupervisor* supervisor,
                                          const drive::DriveState& axis,
                                          std::optional<TimePoint> stopped);
  /// Returns whether nothing should be concluded from the latest position (is_in_doubt()).
  [[nodiscard]] bool in_doubt() const { return is_in_doubt(profile_, samples_); }

  /// Forgets all samples, after the link was lost.
  void forget();

 private:
  void add(const drive::DriveState& axis);
  void enter(const Condition& condition, const drive::DriveState& axis);

  const RigConfig& config_;
  const drive::DriveProfile& profile_;
  std::vector<AxisSample> samples_;  // never grows beyond its first capacity
  Condition before_;
  AxisOrder order_;  // of the current state, unless a supervisor gives it
};

}  // namespace hydroprint::rig
