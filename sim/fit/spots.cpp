#include "sim/fit/spots.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <limits>
#include <utility>

namespace hydroprint::fit {
namespace {

namespace bg = boost::geometry;
using Eigen::Vector3d;
using Corner = bg::model::point<double, 3, bg::cs::cartesian>;
using Box = bg::model::box<Corner>;
using Entry = std::pair<Box, int>;
using Tree = bg::index::rtree<Entry, bg::index::rstar<16>>;

Corner corner_of(const Vector3d& p) { return {p.x(), p.y(), p.z()}; }

std::array<Vector3d, 3> corners_of(const mesh::Surface& surface, int triangle) {
  const Eigen::Vector3i& v = surface.triangles[triangle];
  return {surface.points[v[0]], surface.points[v[1]], surface.points[v[2]]};
}

Tree tree_of(const mesh::Surface& surface) {
  std::vector<Entry> entries;
  entries.reserve(surface.triangles.size());
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    const auto [a, b, c] = corners_of(surface, t);
    entries.emplace_back(
        Box(corner_of(a.cwiseMin(b).cwiseMin(c)), corner_of(a.cwiseMax(b).cwiseMax(c))), t);
  }
  return Tree(entries);
}

/// Returns the barycentric coordinates of the triangle's point nearest to p.
Vector3d nearest_in(const std::array<Vector3d, 3>& corners, const Vector3d& p) {
  const Vector3d ab = corners[1] - corners[0], ac = corners[2] - corners[0];
  const Vector3d normal = ab.cross(ac);
  const double square = normal.squaredNorm();
  if (square > 0) {
    const Vector3d ap = p - corners[0];
    const double b = normal.dot(ap.cross(ac)) / square, c = normal.dot(ab.cross(ap)) / square;
    if (b >= 0 && c >= 0 && b + c <= 1) return {1 - b - c, b, c};
  }
  Vector3d best = Vector3d::UnitX();
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const Vector3d along = corners[j] - corners[i];
    const double length2 = along.squaredNorm();
    const double share =
        length2 > 0 ? std::clamp((p - corners[i]).dot(along) / length2, 0.0, 1.0) : 0;
    const double distance = (corners[i] + share * along - p).norm();
    if (distance >= least) continue;
    least = distance;
    best.setZero();
    best[i] = 1 - share;
    best[j] = share;
  }
  return best;
}

/// Returns the distance of p from a triangle's bounding box.
double box_distance(const std::array<Vector3d, 3>& corners, const Vector3d& p) {
  const auto& [a, b, c] = corners;
  const Vector3d below = a.cwiseMin(b).cwiseMin(c) - p;
  const Vector3d above = p - a.cwiseMax(b).cwiseMax(c);
  return below.cwiseMax(above).cwiseMax(0.0).norm();
}

Spot nearest_spot(const mesh::Surface& surface, const Tree& tree, const Vector3d& p) {
  Spot best;
  best.distance_mm = std::numeric_limits<double>::infinity();
  // Boxes are visited nearest first.
  const auto nearest = bg::index::nearest(corner_of(p), static_cast<unsigned>(tree.size()));
  for (auto entry = tree.qbegin(nearest); entry != tree.qend(); ++entry) {
    const int triangle = entry->second;
    const auto corners = corners_of(surface, triangle);
    if (box_distance(corners, p) > best.distance_mm) break;
    const Vector3d b = nearest_in(corners, p);
    const double distance = (b[0] * corners[0] + b[1] * corners[1] + b[2] * corners[2] - p).norm();
    const bool is_nearer =
        distance < best.distance_mm || (distance == best.distance_mm && triangle < best.triangle);
    if (is_nearer) best = {triangle, b, distance};
  }
  return best;
}

}  // namespace

Result<std::vector<Spot>> nearest_spots(const mesh::Surface& surface,
                                        const std::vector<Vector3d>& points_mm,
                                        const Context& context) {
  const Tree tree = tree_of(surface);
  std::vector<Spot> spots(points_mm.size());
  HP_RETURN_IF_ERROR(parallel_for(context, {}, spots.size(), [&](std::size_t i) -> Status {
    spots[i] = nearest_spot(surface, tree, points_mm[i]);
    return {};
  }));
  return spots;
}

}  // namespace hydroprint::fit
