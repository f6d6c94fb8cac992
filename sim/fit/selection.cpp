#include "sim/fit/selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace hydroprint::fit {
namespace {

using Eigen::Vector2d;

constexpr double kOffSurface_mm = 1;
constexpr double kApart_mm = 1;
constexpr std::size_t kLeastPlaces = 4;
constexpr double kOutlierSigmas = 4;
/// Median of the absolute value of a standard normal variable.
constexpr double kNormalMedian = 0.6744897501960817;

/// Returns the number of used points that are at least kApart_mm apart; at most kLeastPlaces.
std::size_t places(const std::vector<PointResult>& points) {
  std::vector<Vector2d> apart;
  for (const PointResult& p : points) {
    if (!p.is_used()) continue;
    const bool is_new = std::none_of(apart.begin(), apart.end(), [&](const Vector2d& other) {
      return (other - p.point.film_mm).norm() < kApart_mm;
    });
    if (is_new) apart.push_back(p.point.film_mm);
    if (apart.size() == kLeastPlaces) break;
  }
  return apart.size();
}

/// Returns the most frequent reason, empty if there is none.
std::string main_reason(const std::vector<PointResult>& points) {
  std::map<std::string, int> counts;
  for (const PointResult& p : points) {
    if (!p.is_used()) ++counts[p.left_out];
  }
  const auto most =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? std::string() : most->first;
}

}  // namespace

std::string geometric_objection(const Point& point, const Spot& spot, const waterline::Body& body,
                                const film::Outline& outline) {
  if (!(spot.distance_mm <= kOffSurface_mm)) {
    return "the measured point lies more than 1 mm off the object's surface";
  }
  if (!film::contains(outline, point.film_mm)) return "the printed point lies outside the film";
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    normal += spot.barycentric[i] * body.corner_normals[spot.triangle][i];
  }
  if (-normal.normalized().z() < std::cos(waterline::kThetaLimit_rad)) {
    return "the surface at the measured point faces up, within 10 degrees of level, where theta in "
           "eq. (1) is clamped";
  }
  return {};
}

Status check_enough(const std::vector<PointResult>& points, const std::string& name) {
  const std::size_t found = places(points);
  if (found >= kLeastPlaces) return {};
  const auto used =
      std::count_if(points.begin(), points.end(), [](const PointResult& p) { return p.is_used(); });
  std::string what = fmt::format(
      "{}: too few points: {} of {} can be used, and only {} of them are at least 1 mm apart on "
      "the film",
      name, used, points.size(), found);
  if (const std::string why = main_reason(points); !why.empty()) {
    what += " (most of the others: " + why + ")";
  }
  return fail(Code::kInvalidArgument,
              what + ". Measure at least 4 points, preferably dozens, spread over the printed part",
              ErrorReason::TOO_FEW_POINTS);
}

int mark_outliers(std::vector<PointResult>& points, double floor_mm) {
  std::vector<double> sizes;
  for (const PointResult& p : points) {
    if (!p.is_used()) continue;
    const Vector2d r = p.after_mm - p.point.film_mm;
    sizes.push_back(std::abs(r.x()));
    sizes.push_back(std::abs(r.y()));
  }
  if (sizes.empty()) return 0;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const double most = kOutlierSigmas * std::hypot(*middle / kNormalMedian, floor_mm);
  int found = 0;
  for (PointResult& p : points) {
    if (!p.is_used()) continue;
    const bool is_outlier = (p.after_mm - p.point.film_mm).norm() > most;
    if (is_outlier && !p.is_outlier) ++found;
    p.is_outlier = is_outlier;
  }
  return found;
}

}  // namespace hydroprint::fit
