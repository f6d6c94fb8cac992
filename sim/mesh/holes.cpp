#include "sim/mesh/holes.h"

#include <algorithm>
#include <functional>

#include "sim/mesh/groups.h"

namespace hydroprint::mesh {

std::vector<Hole> holes_of(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& weld,
                           const std::vector<Eigen::Vector3i>& triangles, const Edges& edges) {
  std::vector<SideEnds> boundary;
  for (std::size_t e = 0; e < edges.size(); ++e)
    if (edges.sides(e).size() == 1)
      boundary.push_back(side_ends(edges.sides(e)[0], triangles, weld));
  if (boundary.empty()) return {};
  Groups groups(points.size());
  for (const SideEnds& edge : boundary)
    groups.join(static_cast<std::size_t>(edge.from), static_cast<std::size_t>(edge.to));

  std::vector<std::size_t> hole_of(points.size(), points.size());
  std::vector<Hole> out;
  for (const SideEnds& edge : boundary) {
    std::size_t& hole = hole_of[groups.find(static_cast<std::size_t>(edge.from))];
    if (hole == points.size()) {
      hole = out.size();
      out.emplace_back();
    }
    const Eigen::Vector3d& from = points[static_cast<std::size_t>(edge.from)];
    const Eigen::Vector3d& to = points[static_cast<std::size_t>(edge.to)];
    const double length_mm = (to - from).norm();
    out[hole].middle_mm += length_mm * (from + to) / 2;
    out[hole].length_mm += length_mm;
    ++out[hole].edges;
  }
  for (Hole& hole : out) hole.middle_mm /= hole.length_mm;
  std::ranges::stable_sort(out, std::greater{}, &Hole::length_mm);
  return out;
}

}  // namespace hydroprint::mesh
