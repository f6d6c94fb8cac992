#include "sim/calibrate/calibrate.h"

#include <algorithm>
#include <utility>

#include "sim/registration/pairs.h"
#include "sim/scan/fusion.h"

namespace hydroprint::calibrate {
namespace {

constexpr double kOnSurface_mm = 5;  ///< points farther from the object belong to something else
constexpr double kUsualHeight_mm = 40;
constexpr double kUnknownScale = 0.02, kUnknownFocal = 0.02, kUnknownCentre_px = 8;

Pose nominal_pose(const Task& task) {
  Pose out = task.nominal_FO.value_or(Pose::Identity());
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : task.surface.points) box.extend(out.linear() * p);
  if (!task.nominal_FO) out.translation() = -box.center();
  out.translation().z() =
      task.gripper_mm ? *task.gripper_mm - box.max().z() : kUsualHeight_mm - box.min().z();
  return out;
}

registration::ObjectTask object_task(const Task& task) {
  registration::ObjectTask out;
  out.surface = task.surface;
  out.nominal_FO = nominal_pose(task);
  out.surroundings = task.layout.surroundings;
  if (task.gripper_mm) out.surroundings.gripper_from_mm = *task.gripper_mm - kOnSurface_mm;
  return out;
}

/// Adds the scan's points on the object and their distances from it.
Status add_points(const scan::Cloud& cloud, const Task& task, Calibration& out,
                  const Context& context) {
  const auto points =
      registration::object_points(cloud, out.film_frame, task.layout.surroundings).all;
  const Pose& X_CO = out.object.fit.X_CB;
  const Pose X_OC = X_CO.inverse();
  HP_ASSIGN_OR_RETURN(const auto pairs,
                      registration::pair_up(registration::Shape(task.surface), points, X_CO,
                                            registration::Pairing::kOnRay, kOnSurface_mm, context));
  for (const registration::Pair& pair : pairs) {
    out.points_O.push_back(X_OC * pair.scan->point_mm);
    out.off_mm.push_back(pair.residual_mm);
  }
  return {};
}

/// Returns the registration error at each point of the surface, from the pose's covariance.
std::vector<double> error_map(const Task& task, const registration::ObjectPose& object) {
  std::vector<Eigen::Vector3d> points_F;
  points_F.reserve(task.surface.points.size());
  for (const Eigen::Vector3d& p : task.surface.points) points_F.push_back(object.X_FO * p);
  return registration::error_at(points_F, object.centre_mm, object.covariance);
}

/// Adds to the error that the gripper may have been taken for part of the object.
tl::unexpected<Error> without_gripper(const Task& task, Error error) {
  if (!task.gripper_mm && error.reason != ErrorReason::NO_OBJECT)
    error.message +=
        " (the gripper height is not given, so the gripper counts as part of the object)";
  return tl::unexpected(std::move(error));
}

Warnings all_warnings(const Task& task, const Calibration& found) {
  Warnings out = found.film_frame.warnings;
  out.insert(out.end(), found.object.warnings.begin(), found.object.warnings.end());
  const Warnings pose = pose_warnings(found.uncertainty, {OfItem{"object"}});
  out.insert(out.end(), pose.begin(), pose.end());
  const Warnings camera = camera_warnings(task.camera);
  out.insert(out.end(), camera.begin(), camera.end());
  if (!found.water)
    out.push_back({WarningCode::WATER_NOT_SEEN,
                   "too little water is in view to measure its level. "
                   "The layout's z = 0 is used instead",
                   {OfItem{"water"}}});
  return out;
}

}  // namespace

double error_quantile_mm(std::vector<double> error_mm, double share) {
  if (error_mm.empty()) return 0;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(error_mm.size() - 1));
  std::nth_element(error_mm.begin(), error_mm.begin() + at, error_mm.end());
  return error_mm[static_cast<std::size_t>(at)];
}

Result<Calibration> calibrate(const Task& task, const Context& context) {
  const scan::DepthNoise noise;
  HP_ASSIGN_OR_RETURN(const scan::FusedFrame fused, scan::fuse(task.frames, noise, context));
  HP_ASSIGN_OR_RETURN(const scan::Cloud cloud,
                      scan::make_cloud(fused, task.camera, noise, context));
  Calibration out;
  context.progress("markers", 0);
  HP_ASSIGN_OR_RETURN(out.film_frame,
                      registration::find_film_frame(cloud, task.layout.surroundings.layout,
                                                    task.layout.nominal_FC.inverse(), context));
  context.progress("object", 0);
  auto object =
      registration::find_object(cloud, fused.mean, out.film_frame, object_task(task), context);
  if (!object) return without_gripper(task, std::move(object).error());
  out.object = std::move(*object);
  const auto water = registration::water_level(cloud, out.film_frame, task.half_film_mm);
  if (water) out.water = *water;
  HP_RETURN_IF_ERROR(add_points(cloud, task, out, context));
  out.error_mm = error_map(task, out.object);
  out.uncertainty = {error_quantile_mm(out.error_mm, 0.95), out.object.weak};
  out.warnings = all_warnings(task, out);
  return out;
}

registration::CameraCalibration uncalibrated(const scan::Lens& nominal) {
  registration::CameraCalibration out;
  out.lens = nominal;
  scan::Lens::Vector sigma = scan::Lens::Vector::Zero();
  sigma << kUnknownFocal * nominal.fx_px, kUnknownFocal * nominal.fy_px, kUnknownCentre_px,
      kUnknownCentre_px, 0.1, 0.3, 0.002, 0.002, kUnknownScale;
  out.covariance = sigma.cwiseAbs2().asDiagonal();
  return out;
}

Warnings camera_warnings(const registration::CameraCalibration& camera) {
  if (camera.views > 0) return {};
  return {{WarningCode::CAMERA_NOT_CALIBRATED,
           "lens and depth scale come from the driver, so depths may be off by 1 to 2 %: "
           "use calibrate-camera",
           {OfItem{"camera"}}}};
}

}  // namespace hydroprint::calibrate
