#include "sim/registration/film_frame/markers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "sim/registration/icp.h"
#include "sim/registration/segments.h"

namespace hydroprint::registration {
namespace {

constexpr double kJump_mm = 10;
constexpr double kCut_mm = 8;  ///< height above a level area at which clusters are cut off
constexpr double kSameCut_mm = 4;
constexpr double kAboveBase_mm = 4;  ///< lower points may belong to the bar
constexpr double kSlack_mm = 12;     ///< tolerance of a piece's height
constexpr double kMargin_mm = 6;     ///< margin around a marker; points within it count as its own
constexpr double kLeastOfHeight = 0.3;  ///< smallest height of a cluster, relative to a marker's
constexpr std::size_t kFewestPoints = 80;
constexpr std::size_t kTargetSamples = 1500;
constexpr std::size_t kIcpPoints = 400;
constexpr double kIcpReach_mm = 15;
constexpr int kIcpIterations = 30;
constexpr double kLeastUpright = 0.966;  ///< cosine of 15 degrees
constexpr double kMostSigmas = 1.8;
constexpr double kLeastPaired = 0.75;
constexpr double kSurelyPaired = 0.9;
constexpr double kSame_mm = 20;
/// FitOptions::weak_sigma_mm so large that no direction is weak, because there is no nominal pose.
constexpr double kAny_mm = 1e3;

/// Data that all candidates share.
struct Search {
  const scan::Cloud& cloud;
  const Plane& level;
  const MarkerLayout& layout;
  Shape shape;
  std::unique_ptr<const Icp> icp;
};

/// Returns the heights at which clusters are cut off from the level area on which they stand. This
/// may be the markers' own level or, if that is not visible, the water below.
std::vector<double> cuts(const Search& s) {
  double lowest = INFINITY;
  for (const Marker& m : s.layout.markers) lowest = std::min(lowest, m.X_FM.translation().z());
  std::vector<double> out;
  for (const double level : level_heights(s.cloud, s.level)) {
    for (const double cut : {level + kCut_mm, level + lowest + kCut_mm}) {
      const auto same = [&](double other) { return std::abs(other - cut) < kSameCut_mm; };
      if (std::none_of(out.begin(), out.end(), same)) out.push_back(cut);
    }
  }
  return out;
}

/// Returns the clusters above a cut that are about as tall and as wide as a pyramid.
std::vector<std::vector<int>> candidates(const Search& s, double cut_mm) {
  const auto& points = s.cloud.points;
  std::vector<bool> chosen(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    chosen[i] = s.level.height_mm(points[i].point_mm) > cut_mm;
  auto pieces = segments(s.cloud, chosen, kJump_mm);
  const auto is_other = [&](const std::vector<int>& piece) {
    double top = 0;
    Eigen::AlignedBox3d box;
    for (const int i : piece) {
      const Eigen::Vector3d& p = points[static_cast<std::size_t>(i)].point_mm;
      top = std::max(top, s.level.height_mm(p) - cut_mm);
      box.extend(p);
    }
    return piece.size() < kFewestPoints || top > s.layout.height_mm + kSlack_mm ||
           top < kLeastOfHeight * s.layout.height_mm ||
           box.diagonal().norm() > 2 * s.layout.width_mm;
  };
  std::erase_if(pieces, is_other);
  return pieces;
}

/// Estimates the position of the tip. In the part of a pyramid above a fifth of its height, the
/// highest tenth of the points is, on average, a sixth of the pyramid's height below the tip.
Eigen::Vector3d tip_of(const Search& s, std::vector<int> piece) {
  const auto at = [&](int i) -> const Eigen::Vector3d& {
    return s.cloud.points[static_cast<std::size_t>(i)].point_mm;
  };
  const std::size_t tenth = std::max<std::size_t>(1, piece.size() / 10);
  std::nth_element(
      piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(tenth), piece.end(),
      [&](int a, int b) { return s.level.height_mm(at(a)) > s.level.height_mm(at(b)); });
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < tenth; ++k) sum += at(piece[k]);
  return sum / static_cast<double>(tenth) + s.layout.height_mm / 6 * s.level.normal;
}

/// Returns the points around a marker at the given pose, without those of its base.
std::vector<scan::ScanPoint> around(const Search& s, const Pose& X_CM) {
  std::vector<scan::ScanPoint> out;
  const Pose X_MC = X_CM.inverse();
  const double reach = s.layout.width_mm / 2 + kMargin_mm;
  for (const scan::ScanPoint& p : s.cloud.points) {
    const Eigen::Vector3d at = X_MC * p.point_mm;
    if (at.z() > kAboveBase_mm && at.z() < s.layout.height_mm + kSlack_mm &&
        at.head<2>().cwiseAbs().maxCoeff() < reach)
      out.push_back(p);
  }
  return out;
}

Pose standing(const Search& s, const Eigen::Vector3d& tip, double yaw_rad) {
  Pose X_CM = Pose::Identity();
  const Eigen::Quaterniond upright =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), s.level.normal);
  X_CM.linear() = (upright * Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ())).matrix();
  X_CM.translation() = tip - s.layout.height_mm * s.level.normal;
  return X_CM;
}

bool is_pyramid(const Search& s, const PoseFit& fit) {
  return fit.X_CB.linear().col(2).dot(s.level.normal) > kLeastUpright &&
         fit.rms_sigmas < kMostSigmas && fit.paired_share > kLeastPaired;
}

/// Aligns a marker with ICP. Then selects the points near the current pose and fits the pose to
/// them, twice.
std::optional<FoundMarker> fitted_from(const Search& s, Pose X_CM, const Context& context) {
  FitOptions options;
  options.weak_sigma_mm = kAny_mm;
  FoundMarker out;
  out.points = around(s, X_CM);
  if (out.points.size() < kFewestPoints) return {};
  X_CM = s.icp->align(thinned(out.points, kIcpPoints), X_CM.inverse(), kIcpReach_mm, kIcpIterations)
             .pose.inverse();
  for (int round = 0; round < 2; ++round) {
    out.points = around(s, X_CM);
    if (out.points.size() < kFewestPoints) return {};
    const auto fit = fit_pose(s.shape, out.points, s.cloud.camera, X_CM, X_CM, options, context);
    if (!fit) return {};
    out.fit = *fit;
    X_CM = fit->X_CB;
  }
  if (!is_pyramid(s, out.fit)) return {};
  return out;
}

/// Returns the best fit from three initial rotations within a quarter turn, after which the shape
/// repeats.
std::optional<FoundMarker> fitted(const Search& s, const Eigen::Vector3d& tip,
                                  const Context& context) {
  std::optional<FoundMarker> best;
  for (int third = 0; third < 3; ++third) {
    auto found = fitted_from(s, standing(s, tip, third * std::numbers::pi / 6), context);
    if (!found || (best && found->fit.paired_share <= best->fit.paired_share)) continue;
    best = std::move(found);
    if (best->fit.paired_share > kSurelyPaired) break;
  }
  return best;
}

}  // namespace

mesh::Surface pyramid(double width_mm, double height_mm) {
  const double half = width_mm / 2;
  mesh::Surface out;
  out.points = {
      {-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}, {0, 0, height_mm}};
  out.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  out.weld = {0, 1, 2, 3, 4};
  out.source_triangle = {0, 1, 2, 3};
  const std::array<Eigen::Vector3f, 3> whole = {Eigen::Vector3f::UnitX(), Eigen::Vector3f::UnitY(),
                                                Eigen::Vector3f::UnitZ()};
  out.source_barycentric.assign(4, whole);
  for (const auto& t : out.triangles) {
    const Eigen::Vector3d a = out.points[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d b = out.points[static_cast<std::size_t>(t[1])];
    const Eigen::Vector3d normal = (b - a).cross(out.points[4] - a).normalized();
    out.corner_normals.push_back({normal, normal, normal});
  }
  return out;
}

Result<std::vector<FoundMarker>> find_markers(const scan::Cloud& cloud, const Plane& level,
                                              const MarkerLayout& layout, const Context& context) {
  const Shape shape(pyramid(layout.width_mm, layout.height_mm));
  HP_ASSIGN_OR_RETURN(auto icp, make_icp(shape.samples(kTargetSamples)));
  const Search search{cloud, level, layout, shape, std::move(icp)};
  std::vector<FoundMarker> out;
  const auto is_known = [&](const Eigen::Vector3d& place) {
    return std::any_of(out.begin(), out.end(), [&](const FoundMarker& other) {
      return (other.place_C() - place).norm() < kSame_mm;
    });
  };
  for (const double cut : cuts(search)) {
    for (const auto& piece : candidates(search, cut)) {
      HP_RETURN_IF_ERROR(check_cancelled(context));
      const Eigen::Vector3d tip = tip_of(search, piece);
      if (is_known(tip - layout.height_mm * level.normal)) continue;
      auto found = fitted(search, tip, context);
      if (found && !is_known(found->place_C())) out.push_back(std::move(*found));
    }
  }
  return out;
}

}  // namespace hydroprint::registration
