#include "sim/scan/marching.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace hydroprint::scan {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// Tetrahedra around the cube's diagonal, with corners numbered as in cube_corner(). Of any two
/// corners of a tetrahedron, the number of one contains all bits of the other's.
constexpr std::array<std::array<int, 4>, 6> kTetrahedra = {
    {{0, 1, 3, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 6, 7}, {0, 4, 5, 7}, {0, 1, 5, 7}}};

double at(const std::array<double, 8>& values, int corner) {
  return values[static_cast<std::size_t>(corner)];
}

Vector3d mean(const std::vector<int>& corners) {
  Vector3d sum = Vector3d::Zero();
  for (const int c : corners) sum += cube_corner(c).cast<double>();
  return sum / static_cast<double>(corners.size());
}

}  // namespace

MarchingTetrahedra::MarchingTetrahedra(const Vector3i& count, const Vector3d& origin_mm,
                                       double spacing_mm)
    : count_(count), origin_mm_(origin_mm), spacing_mm_(spacing_mm) {}

void MarchingTetrahedra::add(const Vector3i& cell, const std::array<double, 8>& values) {
  const auto is_outside = [](double value) { return value > 0; };
  if (std::all_of(values.begin(), values.end(), is_outside) ||
      std::none_of(values.begin(), values.end(), is_outside)) {
    return;
  }
  for (const auto& corners : kTetrahedra) add_tetrahedron(cell, values, corners);
}

/// Returns the index of the point between two corners where the value is zero. All cubes at this
/// edge share the point.
int MarchingTetrahedra::cut(const Vector3i& cell, const std::array<double, 8>& values, int a,
                            int b) {
  if ((a & b) != a) std::swap(a, b);
  const Vector3i low = cell + cube_corner(a);
  const std::uint64_t id =
      ((static_cast<std::uint64_t>(low.z()) * static_cast<std::uint64_t>(count_.y()) +
        static_cast<std::uint64_t>(low.y())) *
           static_cast<std::uint64_t>(count_.x()) +
       static_cast<std::uint64_t>(low.x())) *
          8 +
      static_cast<std::uint64_t>(a ^ b);
  const auto [found, is_new] = points_.try_emplace(id, static_cast<int>(mesh_.points_mm.size()));
  if (is_new) {
    const double share = at(values, a) / (at(values, a) - at(values, b));
    const Vector3d place =
        low.cast<double>() + Vector3d::Constant(0.5) + share * cube_corner(a ^ b).cast<double>();
    mesh_.points_mm.emplace_back(origin_mm_ + spacing_mm_ * place);
  }
  return found->second;
}

void MarchingTetrahedra::add_triangle(Vector3i corners, const Vector3d& outward) {
  const Vector3d& p = mesh_.points_mm[static_cast<std::size_t>(corners[0])];
  const Vector3d normal = (mesh_.points_mm[static_cast<std::size_t>(corners[1])] - p)
                              .cross(mesh_.points_mm[static_cast<std::size_t>(corners[2])] - p);
  if (normal.dot(outward) < 0) std::swap(corners[1], corners[2]);
  mesh_.triangles.push_back(corners);
}

void MarchingTetrahedra::add_tetrahedron(const Vector3i& cell, const std::array<double, 8>& values,
                                         const std::array<int, 4>& corners) {
  std::vector<int> inside, outside;
  for (const int c : corners) (at(values, c) > 0 ? outside : inside).push_back(c);
  if (inside.empty() || outside.empty()) return;
  const Vector3d outward = mean(outside) - mean(inside);
  const auto point = [&](int a, int b) { return cut(cell, values, a, b); };
  if (inside.size() == 2) {
    const int p = point(inside[0], outside[0]), q = point(inside[1], outside[1]);
    add_triangle({p, point(inside[0], outside[1]), q}, outward);
    add_triangle({p, q, point(inside[1], outside[0])}, outward);
    return;
  }
  const bool is_one_in = inside.size() == 1;
  const int alone = is_one_in ? inside[0] : outside[0];
  const std::vector<int>& others = is_one_in ? outside : inside;
  add_triangle({point(alone, others[0]), point(alone, others[1]), point(alone, others[2])},
               outward);
}

}  // namespace hydroprint::scan
