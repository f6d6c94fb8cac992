#include "sim/registration/starts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "sim/base/check.h"
#include "sim/registration/icp.h"

namespace hydroprint::registration {
namespace {

constexpr std::size_t kScanPoints = 400;
constexpr std::size_t kTargetSamples = 3000;
constexpr std::size_t kEyeSamples = 300;
constexpr double kAround_rad = 20 * std::numbers::pi / 180;
constexpr double kFar_mm = 40, kNear_mm = 10;
constexpr int kIterations = 15;
constexpr std::size_t kRealignedStarts = 12;  ///< best starts, which are aligned a second time
constexpr double kCapped_mm = 6;
constexpr double kAlike_rad = 3 * std::numbers::pi / 180;
constexpr double kAlike_mm = 3;

std::vector<Eigen::Matrix3d> quarter_turns() {
  std::vector<Eigen::Matrix3d> out;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      if (a == b) continue;
      for (int signs = 0; signs < 4; ++signs) {
        Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
        turn(a, 0) = (signs & 1) != 0 ? -1 : 1;
        turn(b, 1) = (signs & 2) != 0 ? -1 : 1;
        turn.col(2) = turn.col(0).cross(turn.col(1));
        out.push_back(turn);
      }
    }
  }
  return out;
}

/// Returns the initial orientations, without the nominal one.
std::vector<Eigen::Matrix3d> turns(const Eigen::Matrix3d& nominal) {
  std::vector<Eigen::Matrix3d> out;
  for (int axis = 0; axis < 3; ++axis)
    for (const double angle : {-kAround_rad, kAround_rad})
      out.emplace_back(Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)) * nominal);
  for (const auto& quarter : quarter_turns())
    if (!quarter.isIdentity()) out.emplace_back(nominal * quarter);
  return out;
}

Eigen::Vector3d middle(const std::vector<SurfacePoint>& points) {
  HP_CHECK(!points.empty());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& p : points) sum += p.point_mm;
  return sum / static_cast<double>(points.size());
}

/// Returns a pose with the given orientation, with the camera-facing part of the body at the middle
/// of the scan.
Pose placed(const Eigen::Matrix3d& turn, const std::vector<SurfacePoint>& body,
            const Eigen::Vector3d& middle_C) {
  std::vector<SurfacePoint> facing;
  for (const auto& p : body)
    if ((turn * p.normal).dot(middle_C) < 0) facing.push_back(p);
  Pose out = Pose::Identity();
  out.linear() = turn;
  out.translation() = middle_C - turn * middle(facing.empty() ? body : facing);
  return out;
}

struct Rough {
  Pose X_CB;
  double cost = 0;  ///< mean squared distance, capped
  bool nominal = false;
};

double cost_of(const Shape& shape, const std::vector<SurfacePoint>& scan, const Pose& X_BC) {
  double sum = 0;
  for (const auto& p : scan) {
    const Eigen::Vector3d p_B = X_BC * p.point_mm;
    const SurfacePoint near = shape.closest(p_B);
    const bool looks_alike = near.normal.dot(X_BC.linear() * p.normal) > 0.4;
    const double off =
        looks_alike ? std::min(kCapped_mm, (near.point_mm - p_B).norm()) : kCapped_mm;
    sum += off * off;
  }
  return sum / static_cast<double>(scan.size());
}

bool alike(const Pose& a, const Pose& b) {
  const Pose step = a.inverse() * b;
  return step.translation().norm() < kAlike_mm &&
         Eigen::AngleAxisd(step.linear()).angle() < kAlike_rad;
}

}  // namespace

Result<std::vector<Pose>> rough_alignments(const Shape& shape,
                                           std::span<const scan::ScanPoint> points,
                                           const Pose& nominal_CB, std::size_t most,
                                           const Context& context) {
  const auto scan = thinned(points, kScanPoints);
  const auto body = shape.samples(kEyeSamples);
  HP_ASSIGN_OR_RETURN(const auto icp, make_icp(shape.samples(kTargetSamples)));
  // The nominal pose itself is tried too, because the scan may show more than the body.
  std::vector<Pose> from{nominal_CB, placed(nominal_CB.linear(), body, middle(scan))};
  for (const auto& turn : turns(nominal_CB.linear()))
    from.push_back(placed(turn, body, middle(scan)));
  std::vector<Rough> rough(from.size());
  const auto align = [&](std::size_t i, double distance_mm) {
    const Pose X_BC = icp->align(scan, rough[i].X_CB.inverse(), distance_mm, kIterations).pose;
    rough[i].X_CB = X_BC.inverse();
    rough[i].cost = cost_of(shape, scan, X_BC);
  };
  const auto look = [&](std::size_t i) -> Status {
    rough[i] = {from[i], 0, i == 0};
    align(i, kFar_mm);
    return {};
  };
  HP_RETURN_IF_ERROR(parallel_for(context, "aligning", from.size(), look));
  const auto best_first = [&] {
    std::stable_sort(rough.begin(), rough.end(),
                     [](const Rough& a, const Rough& b) { return a.cost < b.cost; });
  };
  best_first();
  const auto realign = [&](std::size_t i) -> Status {
    if (i < kRealignedStarts || rough[i].nominal) align(i, kNear_mm);
    return {};
  };
  HP_RETURN_IF_ERROR(parallel_for(context, "", rough.size(), realign));
  best_first();
  std::vector<Pose> out;
  for (const Rough& r : rough) {
    const bool known =
        std::any_of(out.begin(), out.end(), [&](const Pose& p) { return alike(p, r.X_CB); });
    if (!known && (out.size() < most || r.nominal)) out.push_back(r.X_CB);
  }
  return out;
}

}  // namespace hydroprint::registration
