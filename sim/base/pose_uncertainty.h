#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint {

/// What a calibration states about the error of its pose.
struct PoseUncertainty {
  /// 95th percentile of the registration error over the object's surface; nullopt: not known.
  std::optional<double> error_p95_mm;
  /// Motions that the scan does not determine, in words; the nominal pose determines them instead.
  std::vector<std::string> from_nominal_pose;
};

/// Returns what a message states: a pose or a calibration of the API.
template <class Message>
[[nodiscard]] PoseUncertainty uncertainty_of(const Message& message) {
  PoseUncertainty out;
  if (message.has_error_p95_mm()) out.error_p95_mm = message.error_p95_mm();
  out.from_nominal_pose.assign(message.from_nominal_pose().begin(),
                               message.from_nominal_pose().end());
  return out;
}

/// Sets these fields of a message, which has none of them yet.
template <class Message>
void set_uncertainty(const PoseUncertainty& uncertainty, Message& message) {
  if (uncertainty.error_p95_mm) message.set_error_p95_mm(*uncertainty.error_p95_mm);
  for (const std::string& motion : uncertainty.from_nominal_pose)
    message.add_from_nominal_pose(motion);
}

/// Largest stated error of a pose for which no warning is given.
inline constexpr double kMostPoseError_mm = 1;

/// Returns the reasons to expect a misplaced print, with the remedy: `POSE_UNCONSTRAINED` for each
/// motion from the nominal pose; otherwise `POSE_UNCERTAIN` if the stated error exceeds
/// kMostPoseError_mm.
/// @param where  the source of the pose
[[nodiscard]] Warnings pose_warnings(const PoseUncertainty& uncertainty, const Place& where);

}  // namespace hydroprint
