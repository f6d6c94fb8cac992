#include "sim/overlay/overlay.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <utility>

namespace hydroprint::overlay {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using PlainFace = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using FaceBase = CGAL::Triangulation_face_base_with_info_2<int, Kernel, PlainFace>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
// The lines do not cross, so that no point is constructed and all predicates are exact.
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, Structure, CGAL::No_constraint_intersection_requiring_constructions_tag>;

std::vector<GridPoint> points_of(const std::vector<GridLine>& lines) {
  std::vector<GridPoint> points;
  points.reserve(2 * lines.size());
  for (const GridLine& line : lines) {
    points.push_back(line.a);
    points.push_back(line.b);
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

Triangulation constrained(const std::vector<GridPoint>& points,
                          const std::vector<GridLine>& lines) {
  std::vector<std::pair<Kernel::Point_2, int>> sites;
  sites.reserve(points.size());
  for (const GridPoint& p : points) {
    sites.emplace_back(Kernel::Point_2(static_cast<double>(p.x), static_cast<double>(p.y)),
                       static_cast<int>(sites.size()));
  }
  Triangulation triangulation;
  triangulation.insert(sites.begin(), sites.end());
  std::vector<Triangulation::Vertex_handle> vertices(points.size());
  for (const auto vertex : triangulation.finite_vertex_handles()) vertices[vertex->info()] = vertex;
  const auto vertex_at = [&](const GridPoint& p) {
    return vertices[std::lower_bound(points.begin(), points.end(), p) - points.begin()];
  };
  for (const GridLine& line : lines) {
    triangulation.insert_constraint(vertex_at(line.a), vertex_at(line.b));
  }
  return triangulation;
}

std::vector<Overlay::Triangle> triangles_of(const Triangulation& triangulation) {
  std::vector<Overlay::Triangle> triangles;
  triangles.reserve(triangulation.number_of_faces());
  int index = 0;
  for (const auto face : triangulation.all_face_handles()) {
    face->info() = triangulation.is_infinite(face) ? Overlay::kOutside : index++;
  }
  for (const auto face : triangulation.finite_face_handles()) {
    Overlay::Triangle triangle;
    for (int i = 0; i < 3; ++i) {
      triangle.corners[i] = face->vertex(i)->info();
      triangle.neighbours[i] = face->neighbor(i)->info();
    }
    triangles.push_back(triangle);
  }
  return triangles;
}

/// Looks up the passes of curves between two points.
class Passes {
 public:
  Passes(const std::vector<GridPoint>& points, const std::vector<GridLine>& lines)
      : points_(points), lines_(lines), first_(points.size() + 1, 0) {
    std::size_t line = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
      first_[p] = line;
      while (line < lines.size() && lines[line].a == points[p]) ++line;
    }
    first_.back() = line;
  }

  [[nodiscard]] std::array<int, 2> from_to(int from, int to) const {
    const auto [low, high] = std::minmax(from, to);
    for (std::size_t l = first_[low]; l < first_[low + 1]; ++l) {
      if (lines_[l].b != points_[high]) continue;
      const int sign = from < to ? 1 : -1;
      return {sign * lines_[l].passes[0], sign * lines_[l].passes[1]};
    }
    return {0, 0};
  }

 private:
  const std::vector<GridPoint>& points_;
  const std::vector<GridLine>& lines_;
  std::vector<std::size_t> first_;  ///< the lines that begin at each point
};

/// Sets the winding numbers, from the outside inwards.
void wind(const Passes& passes, std::vector<Overlay::Triangle>& triangles) {
  std::vector<char> is_known(triangles.size(), 0);
  std::vector<int> open;
  const auto passes_at = [&](const Overlay::Triangle& t, int i) {
    return passes.from_to(t.corners[(i + 1) % 3], t.corners[(i + 2) % 3]);
  };
  const auto set = [&](int index, const std::array<int, 2>& windings) {
    if (is_known[index] != 0) return;
    is_known[index] = 1;
    triangles[index].windings = windings;
    open.push_back(index);
  };
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      if (triangles[t].neighbours[i] != Overlay::kOutside) continue;
      set(static_cast<int>(t), passes_at(triangles[t], i));
    }
  }
  while (!open.empty()) {
    const Overlay::Triangle from = triangles[open.back()];
    open.pop_back();
    for (int i = 0; i < 3; ++i) {
      if (from.neighbours[i] == Overlay::kOutside) continue;
      const std::array<int, 2> step = passes_at(from, i);  // the neighbour lies on its right
      set(from.neighbours[i], {from.windings[0] - step[0], from.windings[1] - step[1]});
    }
  }
}

}  // namespace

Overlay triangulate(const std::vector<GridLine>& lines) {
  Overlay overlay;
  overlay.points = points_of(lines);
  overlay.triangles = triangles_of(constrained(overlay.points, lines));
  wind(Passes(overlay.points, lines), overlay.triangles);
  return overlay;
}

double area_mm2(const Overlay& overlay, const Overlay::Triangle& triangle) {
  const GridPoint& a = overlay.points[triangle.corners[0]];
  const GridPoint& b = overlay.points[triangle.corners[1]];
  const GridPoint& c = overlay.points[triangle.corners[2]];
  const auto product = [](std::int64_t x, std::int64_t y) {
    return static_cast<double>(x) * static_cast<double>(y);
  };
  return 0.5 * (product(b.x - a.x, c.y - a.y) - product(b.y - a.y, c.x - a.x)) * kGridSquare_mm2;
}

}  // namespace hydroprint::overlay
