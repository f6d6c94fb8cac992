#include "sim/image/layers/axis_distance.h"

#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

namespace hydroprint::image {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Segments = std::vector<Kernel::Segment_3>;
using Primitive = CGAL::AABB_segment_primitive<Kernel, Segments::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

constexpr double kEqual = 1e-6;  ///< difference of cosines below which two axes are equally near
constexpr std::size_t kPointsAtOnce = 1024;

/// A set of axes: bit a for axis a.
using AxisSet = std::uint8_t;

Kernel::Point_3 to_cgal(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

int nearest_axis(const Eigen::Vector3d& normal, const Eigen::Matrix3d& axes) {
  const Eigen::Vector3d cosines = (axes.transpose() * normal).cwiseAbs() / normal.norm();
  int best = 0;
  for (int a = 1; a < 3; ++a) {
    if (cosines[a] > cosines[best] + kEqual) best = a;
  }
  return best;
}

/// An edge between welded points, and the axis of a triangle at it.
struct AxisEdge {
  int from = 0, to = 0;
  AxisSet axes = 0;
};

/// Returns the axes of the triangles at each edge; an entry for each edge.
std::vector<AxisEdge> edges_of(const mesh::Surface& surface, const std::vector<int>& axis_of) {
  std::vector<AxisEdge> all;
  all.reserve(3 * surface.triangles.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto [from, to] =
          std::minmax({surface.weld[static_cast<std::size_t>(surface.triangles[t][i])],
                       surface.weld[static_cast<std::size_t>(surface.triangles[t][(i + 1) % 3])]});
      all.push_back({from, to, static_cast<AxisSet>(1U << axis_of[t])});
    }
  }
  const auto key = [](const AxisEdge& edge) { return std::pair(edge.from, edge.to); };
  std::ranges::sort(all, {}, key);
  std::vector<AxisEdge> out;
  for (const AxisEdge& edge : all) {
    if (out.empty() || key(out.back()) != key(edge)) {
      out.push_back(edge);
    } else {
      out.back().axes |= edge.axes;
    }
  }
  return out;
}

/// Returns the edges at which triangles of an axis meet others.
Segments ends_of_axis(const mesh::Surface& surface, const std::vector<AxisEdge>& edges, int axis) {
  const auto only = static_cast<AxisSet>(1U << axis);
  Segments out;
  for (const AxisEdge& edge : edges) {
    if ((edge.axes & only) == 0 || edge.axes == only) continue;
    out.emplace_back(to_cgal(surface.points[static_cast<std::size_t>(edge.from)]),
                     to_cgal(surface.points[static_cast<std::size_t>(edge.to)]));
  }
  return out;
}

std::vector<AxisSet> axes_at_points(const mesh::Surface& surface, const std::vector<int>& axis_of) {
  std::vector<AxisSet> welded(surface.points.size(), 0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const int v : surface.triangles[t]) {
      welded[static_cast<std::size_t>(surface.weld[static_cast<std::size_t>(v)])] |=
          static_cast<AxisSet>(1U << axis_of[t]);
    }
  }
  std::vector<AxisSet> out;
  out.reserve(welded.size());
  for (const int first : surface.weld) out.push_back(welded[static_cast<std::size_t>(first)]);
  return out;
}

}  // namespace

Result<AxisDistances> axis_distances(const mesh::Surface& surface, const Eigen::Matrix3d& axes,
                                     double most_mm, const Context& context) {
  std::vector<int> axis_of;
  axis_of.reserve(surface.triangles.size());
  for (const Eigen::Vector3i& t : surface.triangles) {
    const auto& p = surface.points;
    axis_of.push_back(nearest_axis((p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]), axes));
  }
  const std::vector<AxisEdge> edges = edges_of(surface, axis_of);
  const std::vector<AxisSet> sets = axes_at_points(surface, axis_of);
  AxisDistances out(surface.points.size(), Eigen::Vector3f::Constant(static_cast<float>(most_mm)));
  for (int axis = 0; axis < 3; ++axis) {
    const Segments segments = ends_of_axis(surface, edges, axis);
    Tree tree(segments.begin(), segments.end());
    tree.build();
    const auto distance_mm = [&](std::size_t v) {
      if ((sets[v] >> axis & 1U) != 0) return 0.0;
      if (segments.empty()) return most_mm;
      return std::min(most_mm, std::sqrt(tree.squared_distance(to_cgal(surface.points[v]))));
    };
    if (!segments.empty()) tree.accelerate_distance_queries();
    const std::size_t chunks = (out.size() + kPointsAtOnce - 1) / kPointsAtOnce;
    HP_RETURN_IF_ERROR(parallel_for(context, {}, chunks, [&](std::size_t chunk) {
      const std::size_t end = std::min(out.size(), (chunk + 1) * kPointsAtOnce);
      for (std::size_t v = chunk * kPointsAtOnce; v < end; ++v)
        out[v][axis] = static_cast<float>(distance_mm(v));
      return Status{};
    }));
  }
  return out;
}

}  // namespace hydroprint::image
