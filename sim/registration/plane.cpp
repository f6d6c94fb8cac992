#include "sim/registration/plane.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace hydroprint::registration {
namespace {

constexpr int kTrials = 400;
constexpr std::size_t kLooked = 2000;  ///< each trial tests about this many points
constexpr double kNear_mm = 5;
constexpr double kLeastShare = 0.05;
constexpr double kLeastUpright = 0.766;  ///< cosine of 40 degrees
constexpr int kRefinements = 5;
/// Minimum cosine between the plane's normal and that of a level point.
constexpr double kLevel = 0.9;
constexpr double kBin_mm = 3;
constexpr double kLevelShare = 0.01;  ///< minimum size of a level area, as a fraction of all points
constexpr std::size_t kMostLevels = 6;

bool on(const Plane& plane, const scan::ScanPoint& p) {
  return std::abs(plane.height_mm(p.point_mm)) < kNear_mm && plane.normal.dot(p.normal) > 0.8;
}

std::vector<const scan::ScanPoint*> some_of(const scan::Cloud& cloud) {
  std::vector<const scan::ScanPoint*> out;
  const std::size_t step = std::max<std::size_t>(1, cloud.points.size() / kLooked);
  for (std::size_t i = 0; i < cloud.points.size(); i += step) out.push_back(&cloud.points[i]);
  return out;
}

Plane refined(const scan::Cloud& cloud, const Plane& plane) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double count = 0;
  const Eigen::Vector3d origin = plane.normal * plane.offset_mm;
  for (const scan::ScanPoint& p : cloud.points) {
    if (!on(plane, p)) continue;
    const Eigen::Vector3d d = p.point_mm - origin;
    mean += d;
    squares += d * d.transpose();
    ++count;
  }
  if (count < 3) return plane;
  mean /= count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(squares / count -
                                                              mean * mean.transpose());
  Eigen::Vector3d normal = solver.eigenvectors().col(0);
  if (normal.dot(plane.normal) < 0) normal = -normal;
  return {normal, normal.dot(origin + mean)};
}

}  // namespace

Result<Plane> find_plane(const scan::Cloud& cloud, const Eigen::Vector3d& up_C) {
  const auto looked = some_of(cloud);
  std::mt19937 random(1);
  Plane best;
  std::size_t most = 0;
  for (int trial = 0; trial < kTrials && looked.size() >= 3; ++trial) {
    // Does not use std::uniform_int_distribution, because its results differ between standard
    // libraries.
    const auto any = [&] { return looked[random() % looked.size()]->point_mm; };
    const Eigen::Vector3d a = any(), b = any(), c = any();
    Eigen::Vector3d normal = (b - a).cross(c - a);
    if (!(normal.norm() > 100)) continue;
    normal.normalize();
    if (normal.dot(a) > 0) normal = -normal;
    if (normal.dot(up_C.normalized()) < kLeastUpright) continue;
    const Plane plane{normal, normal.dot(a)};
    std::size_t count = 0;
    for (const auto* p : looked) count += on(plane, *p) ? 1 : 0;
    if (count > most) {
      most = count;
      best = plane;
    }
  }
  if (static_cast<double>(most) < kLeastShare * static_cast<double>(looked.size()) || most < 3)
    return fail(Code::kFailedPrecondition,
                "neither water nor table is in view. Aim the camera at the vat",
                ErrorReason::NO_PLANE);
  for (int i = 0; i < kRefinements; ++i) best = refined(cloud, best);
  return best;
}

std::vector<double> level_heights(const scan::Cloud& cloud, const Plane& plane) {
  std::map<int, std::size_t> bins;
  for (const scan::ScanPoint& p : cloud.points)
    if (plane.normal.dot(p.normal) > kLevel)
      ++bins[static_cast<int>(std::floor(plane.height_mm(p.point_mm) / kBin_mm))];
  const auto count = [&](int bin) {
    const auto at = bins.find(bin);
    return at == bins.end() ? 0 : at->second;
  };
  std::vector<std::pair<std::size_t, int>> peaks;
  for (const auto& [bin, points] : bins) {
    const bool is_peak = points > count(bin - 1) && points >= count(bin + 1);
    const std::size_t all = count(bin - 1) + points + count(bin + 1);
    if (is_peak &&
        static_cast<double>(all) > kLevelShare * static_cast<double>(cloud.points.size()))
      peaks.emplace_back(all, bin);
  }
  std::sort(peaks.rbegin(), peaks.rend());
  std::vector<double> out;
  for (const auto& [points, bin] : peaks)
    if (out.size() < kMostLevels) out.push_back((bin + 0.5) * kBin_mm);
  return out;
}

}  // namespace hydroprint::registration
