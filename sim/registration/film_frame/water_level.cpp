#include "sim/registration/film_frame/water_level.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <vector>

#include "sim/base/check.h"
#include "sim/scan/camera_errors.h"

namespace hydroprint::registration {
namespace {

constexpr std::size_t kFewest = 200;
constexpr double kSearch_mm = 15;
constexpr double kNear_mm = 4;
constexpr double kLeastLevel = 0.8;  ///< minimum cosine between a point's normal and up
/// About this many points are used for the camera's part of the error.
constexpr std::size_t kLooked = 500;

struct Height {
  double z_mm;
  double constant_sigma_mm, changing_sigma_mm;
  const scan::ScanPoint* scan;
};

std::vector<Height> heights(const scan::Cloud& cloud, const Pose& X_FC,
                            const Eigen::Vector2d& half_film_mm) {
  std::vector<Height> out;
  for (const auto& p : cloud.points) {
    const Eigen::Vector3d at = X_FC * p.point_mm;
    if (std::abs(at.z()) > kSearch_mm || std::abs(at.x()) > half_film_mm.x() ||
        std::abs(at.y()) > half_film_mm.y())
      continue;
    if ((X_FC.linear() * p.normal).z() < kLeastLevel) continue;
    const double up = (X_FC.linear() * p.point_mm).z() / p.point_mm.z();
    out.push_back({at.z(), up * p.constant_sigma_mm, up * p.sigma_mm, &p});
  }
  return out;
}

/// Variance of the mean height due to noise.
double noise_of_mean(const std::vector<Height>& all) {
  HP_CHECK(!all.empty());
  const auto count = static_cast<double>(all.size());
  double variance = 0;
  std::unordered_map<int, double> patches;
  for (const Height& h : all) {
    variance += std::pow(h.changing_sigma_mm / count, 2);
    patches[h.scan->patch] += h.constant_sigma_mm / count;
  }
  for (const auto& [patch, share] : patches) variance += share * share;
  return variance;
}

/// Variance of the water's height due to the errors of the film frame and of the camera. The
/// camera's errors also move the film frame, so part of them cancels.
double frame_and_camera(const std::vector<Height>& all, const scan::Camera& camera,
                        const FilmFrame& frame) {
  const scan::CameraErrors errors(camera);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::RowVectorXd by_camera = Eigen::RowVectorXd::Zero(errors.count());
  const Eigen::Vector3d up_C = frame.X_CF().linear().col(2);
  const std::size_t step = std::max<std::size_t>(1, all.size() / kLooked);
  double count = 0;
  for (std::size_t i = 0; i < all.size(); i += step, ++count) {
    const scan::ScanPoint& p = *all[i].scan;
    middle += p.point_mm;
    by_camera += errors.along(up_C, p);
  }
  const Matrix6 shift = recentred(frame.fit.centre_mm, middle / count);
  const Eigen::Matrix<double, 1, 6> lift = up_C.transpose() * shift.bottomRows<3>();
  const Eigen::RowVectorXd gain = by_camera / count - frame.camera_gain(lift, errors.count());
  return lift.dot(lift * frame.fit.covariance) + gain.squaredNorm();
}

}  // namespace

Result<WaterLevel> water_level(const scan::Cloud& cloud, const FilmFrame& frame,
                               const Eigen::Vector2d& half_film_mm) {
  const Pose X_FC = frame.X_CF().inverse();
  auto all = heights(cloud, X_FC, half_film_mm);
  if (all.size() < kFewest)
    return fail(
        Code::kFailedPrecondition,
        "too little of the water is in view to measure its level. Aim the camera at the water",
        ErrorReason::NO_WATER);
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end(),
                   [](const Height& a, const Height& b) { return a.z_mm < b.z_mm; });
  const double median = middle->z_mm;
  std::erase_if(all, [&](const Height& h) { return std::abs(h.z_mm - median) > kNear_mm; });
  WaterLevel out;
  out.points = all.size();
  for (const Height& h : all) out.z_mm += h.z_mm / static_cast<double>(all.size());
  out.sigma_mm = std::sqrt(noise_of_mean(all) + frame_and_camera(all, cloud.camera, frame));
  return out;
}

}  // namespace hydroprint::registration
