#include "sim/plan/facets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sim/mesh/groups.h"

namespace hydroprint::plan {
namespace {

std::array<Eigen::Vector2d, 3> lay_flat(const mesh::Surface& surface, const Eigen::Vector3i& t) {
  const auto point = [&](int corner) -> const Eigen::Vector3d& {
    const auto p = static_cast<std::size_t>(t[corner]);
    return surface.points[static_cast<std::size_t>(surface.weld[p])];
  };
  const Eigen::Vector3d ab = point(1) - point(0);
  const Eigen::Vector3d ac = point(2) - point(0);
  const double length = ab.norm();
  return {Eigen::Vector2d(0, 0), Eigen::Vector2d(length, 0),
          Eigen::Vector2d(ab.dot(ac) / length, ab.cross(ac).norm() / length)};
}

}  // namespace

Facets::Facets(const mesh::Surface& surface) : edges_(surface.triangles, surface.weld) {
  const std::size_t sides = 3 * surface.triangles.size();
  flat_.reserve(surface.triangles.size());
  for (const auto& t : surface.triangles) flat_.push_back(lay_flat(surface, t));
  edge_.resize(sides);
  for (std::size_t e = 0; e < edges_.size(); ++e)
    for (const int side : edges_.sides(e)) edge_[static_cast<std::size_t>(side)] = e;
  from_.resize(sides);
  for (std::size_t s = 0; s < sides; ++s)
    from_[s] = mesh::side_ends(static_cast<int>(s), surface.triangles, surface.weld).from;
  join_corners();
}

void Facets::join_corners() {
  const auto next = [](int side) { return side - side % 3 + (side + 1) % 3; };
  const auto index = [](int corner) { return static_cast<std::size_t>(corner); };
  mesh::Groups groups(from_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const auto sides = edges_.sides(e);
    const int first = sides.front();
    for (const int side : sides.subspan(1)) {
      const bool same = same_direction(first, side);
      groups.join(index(first), index(same ? side : next(side)));
      groups.join(index(next(first)), index(same ? next(side) : side));
    }
  }
  vertex_.resize(from_.size());
  int count = 0;
  for (std::size_t c = 0; c < from_.size(); ++c) {
    const std::size_t root = groups.find(c);  // the smallest corner of its vertex
    vertex_[c] = root == c ? count++ : vertex_[root];
  }
  vertex_begin_.assign(index(count) + 1, 0);
  for (const int v : vertex_) ++vertex_begin_[index(v) + 1];
  for (std::size_t v = 0; v < index(count); ++v) vertex_begin_[v + 1] += vertex_begin_[v];
  std::vector<std::size_t> end(vertex_begin_.begin(), vertex_begin_.end() - 1);
  vertex_corners_.resize(from_.size());
  for (std::size_t c = 0; c < from_.size(); ++c)
    vertex_corners_[end[index(vertex_[c])]++] = static_cast<int>(c);
}

SideFrame Facets::frame(int side) const {
  const auto& c = corners(side / 3);
  SideFrame frame;
  frame.origin = c[static_cast<std::size_t>(side % 3)];
  frame.along = c[static_cast<std::size_t>((side + 1) % 3)] - frame.origin;
  frame.length_mm = frame.along.norm();
  frame.along /= frame.length_mm;
  frame.inward = {-frame.along.y(), frame.along.x()};
  return frame;
}

double area_mm2(const mesh::Surface& surface, std::size_t triangle) {
  const auto& p = surface.points;
  const Eigen::Vector3i& t = surface.triangles[triangle];
  return (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).norm() / 2;
}

Eigen::Vector3d place_of(const mesh::Surface& surface, int triangle,
                         const Eigen::Vector3d& barycentric) {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  const auto& t = surface.triangles[static_cast<std::size_t>(triangle)];
  for (int i = 0; i < 3; ++i) {
    const auto point = static_cast<std::size_t>(surface.weld[static_cast<std::size_t>(t[i])]);
    place += barycentric[i] * surface.points[point];
  }
  return place;
}

Eigen::Vector3d on_side(int side, double fraction) {
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  barycentric[side % 3] = 1 - fraction;
  barycentric[(side + 1) % 3] = fraction;
  return barycentric;
}

}  // namespace hydroprint::plan
