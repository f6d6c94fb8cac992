#include "sim/mesh/inner.h"

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/box_intersection_d.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <vector>

#include "sim/mesh/edges.h"
#include "sim/mesh/parallel_rays.h"
#include "sim/mesh/weld.h"

namespace hydroprint::mesh {
namespace {

/// Distance of the rays' origin from the triangle, relative to the model's diagonal.
constexpr double kJustOutside = 1e-5;
/// The place of a corner's ray: so far from the triangle's middle towards the corner.
constexpr double kTowardsCorner = 0.8;
constexpr std::size_t kTrianglesAtOnce = 512;

Corners corners_of(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3i& triangle) {
  const auto point = [&](int k) { return points[static_cast<std::size_t>(triangle[k])]; };
  return {point(0), point(1), point(2)};
}

Corners corners_of(const Surface& surface, std::size_t t) {
  return corners_of(surface.points, surface.triangles[t]);
}

Eigen::Vector3d normal_of(const Corners& c) { return (c[1] - c[0]).cross(c[2] - c[0]); }

/// Returns for each triangle whether its bounding box, widened by `margin_mm`, overlaps that of a
/// triangle with which it shares no point. Where the surface enters another part of it, it does.
std::vector<char> triangles_that_may_meet(const Surface& surface, double margin_mm) {
  using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::size_t>;
  std::vector<Box> boxes;
  boxes.reserve(surface.triangles.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Corners c = corners_of(surface, t);
    const Eigen::Vector3d low = c[0].cwiseMin(c[1]).cwiseMin(c[2]).array() - margin_mm;
    const Eigen::Vector3d high = c[0].cwiseMax(c[1]).cwiseMax(c[2]).array() + margin_mm;
    boxes.emplace_back(CGAL::Bbox_3(low.x(), low.y(), low.z(), high.x(), high.y(), high.z()), t);
  }
  std::vector<char> out(surface.triangles.size(), 0);
  const auto share_a_point = [&](std::size_t t, std::size_t u) {
    for (const int v : surface.triangles[t]) {
      for (const int w : surface.triangles[u]) {
        if (surface.weld[static_cast<std::size_t>(v)] == surface.weld[static_cast<std::size_t>(w)])
          return true;
      }
    }
    return false;
  };
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
    const std::size_t t = a.info(), u = b.info();
    if ((out[t] != 0 && out[u] != 0) || share_a_point(t, u)) return;
    out[t] = out[u] = 1;
  });
  return out;
}

/// Joins triangles that share an edge and meet no others: they lie all inside or all outside.
Groups groups_of_one_side(const Surface& surface, const std::vector<char>& may_meet) {
  const Edges edges(surface.triangles, surface.weld);
  Groups groups(surface.triangles.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto first = static_cast<std::size_t>(edges.sides(e)[0] / 3);
    for (const int side : edges.sides(e)) {
      const auto t = static_cast<std::size_t>(side / 3);
      if (edges.sides(e).size() == 2 && may_meet[first] == 0 && may_meet[t] == 0)
        groups.join(first, t);
    }
  }
  return groups;
}

}  // namespace

std::vector<Corners> closed_shells(const std::vector<Eigen::Vector3d>& points,
                                   const std::vector<Eigen::Vector3i>& triangles,
                                   const Edges& edges) {
  Groups shells = shells_of(triangles.size(), edges);
  std::vector<char> is_open(triangles.size(), 0);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges.sides(e).size() % 2 != 0)
      is_open[shells.find(static_cast<std::size_t>(edges.sides(e)[0] / 3))] = 1;
  }
  std::vector<Corners> out;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (is_open[shells.find(t)] == 0) out.push_back(corners_of(points, triangles[t]));
  return out;
}

Result<std::vector<CornerSet>> inner_corners(const Surface& surface,
                                             const std::vector<Corners>& solids,
                                             const Context& context) {
  const ParallelRays rays(solids);
  const double outside_mm = kJustOutside * diagonal(surface.points);
  std::vector<CornerSet> out(surface.triangles.size(), 0);
  const auto corners_inside = [&](std::size_t t) {
    const auto c = corners_of(surface, t);
    const Eigen::Vector3d middle = (c[0] + c[1] + c[2]) / 3;
    const Eigen::Vector3d shift = outside_mm * normal_of(c).normalized();
    unsigned set = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d p = kTowardsCorner * c[k] + (1 - kTowardsCorner) * middle + shift;
      if (rays.winding(p) > 0) set |= 1U << k;
    }
    return static_cast<CornerSet>(set);
  };
  const std::vector<char> may_meet = triangles_that_may_meet(surface, 2 * outside_mm);
  Groups groups = groups_of_one_side(surface, may_meet);
  std::vector<std::size_t> tested;
  for (std::size_t t = 0; t < out.size(); ++t)
    if (groups.find(t) == t) tested.push_back(t);
  const std::size_t chunks = (tested.size() + kTrianglesAtOnce - 1) / kTrianglesAtOnce;
  HP_RETURN_IF_ERROR(parallel_for(context, {}, chunks, [&](std::size_t chunk) {
    const std::size_t end = std::min(tested.size(), (chunk + 1) * kTrianglesAtOnce);
    for (std::size_t i = chunk * kTrianglesAtOnce; i < end; ++i)
      out[tested[i]] = corners_inside(tested[i]);
    return Status{};
  }));
  constexpr CornerSet kAll = 7, kMostly = 2;
  for (std::size_t t = 0; t < out.size(); ++t) {
    const std::size_t first = groups.find(t);
    if (first != t) out[t] = std::popcount(out[first]) >= kMostly ? kAll : CornerSet{0};
  }
  if (std::ranges::all_of(out, [](CornerSet set) { return set == 0; })) out.clear();
  return out;
}

}  // namespace hydroprint::mesh
