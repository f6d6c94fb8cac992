#include "sim/base/pose_uncertainty.h"

#include <fmt/format.h>

namespace hydroprint {
namespace {

constexpr const char* kTurn =
    "Turn the object so that the camera sees more of its features, or move the camera, and "
    "calibrate "
    "again";
constexpr const char* kMeasureBetter =
    "Calibrate the camera if that has not been done, let it see more of the object and of the "
    "markers, "
    "and calibrate again";

}  // namespace

Warnings pose_warnings(const PoseUncertainty& uncertainty, const Place& where) {
  Warnings out;
  for (const std::string& motion : uncertainty.from_nominal_pose)
    out.push_back({WarningCode::POSE_UNCONSTRAINED,
                   fmt::format("the scan does not determine this part of the pose, so it is taken "
                               "from the nominal pose: {}. {}",
                               motion, kTurn),
                   where});
  const bool is_stated = uncertainty.error_p95_mm && out.empty();
  if (is_stated && !(*uncertainty.error_p95_mm <= kMostPoseError_mm))
    out.push_back({WarningCode::POSE_UNCERTAIN,
                   fmt::format("the pose may be wrong by {:.1f} mm on the surface, more than {:g} "
                               "mm, so the print may be misplaced. {}",
                               *uncertainty.error_p95_mm, kMostPoseError_mm, kMeasureBetter),
                   where});
  return out;
}

}  // namespace hydroprint
