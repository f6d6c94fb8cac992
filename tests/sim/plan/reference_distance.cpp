#include "tests/sim/plan/reference_distance.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_shortest_path.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>

#include "sim/plan/facets.h"

namespace hydroprint::testing {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Paths =
    CGAL::Surface_mesh_shortest_path<CGAL::Surface_mesh_shortest_path_traits<Kernel, Mesh>>;

constexpr double kSampleMm = 0.04;

/// The part of a surface around a point.
class Patch {
 public:
  Patch(const mesh::Surface& surface, const Eigen::Vector3d& centre, double radius_mm) {
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      if (is_near(surface, t, centre, radius_mm)) add(surface, t);
    }
  }

  Mesh mesh;
  std::map<int, Mesh::Face_index> faces;  ///< of triangles

 private:
  static bool is_near(const mesh::Surface& surface, std::size_t t, const Eigen::Vector3d& centre,
                      double radius_mm) {
    double longest = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
      const auto& a = surface.points[std::size_t(surface.triangles[t][i])];
      const auto& b = surface.points[std::size_t(surface.triangles[t][(i + 1) % 3])];
      longest = std::max(longest, (a - b).norm());
      nearest = std::min(nearest, (a - centre).norm());
    }
    return nearest < radius_mm + longest;
  }

  void add(const mesh::Surface& surface, std::size_t t) {
    std::array<Mesh::Vertex_index, 3> corners;
    for (int i = 0; i < 3; ++i) {
      const int point = surface.weld[std::size_t(surface.triangles[t][i])];
      const auto [entry, is_new] = vertices_.try_emplace(point);
      const auto& p = surface.points[std::size_t(point)];
      if (is_new) entry->second = mesh.add_vertex({p.x(), p.y(), p.z()});
      corners[std::size_t(i)] = entry->second;
    }
    const auto face = mesh.add_face(corners[0], corners[1], corners[2]);
    if (face == Mesh::null_face()) throw std::logic_error("the surface is not manifold here");
    faces[static_cast<int>(t)] = face;
  }

  std::map<int, Mesh::Vertex_index> vertices_;
};

/// CGAL's coordinates refer to the face's halfedge: its source is the first corner.
Paths::Barycentric_coordinates to_cgal(const Eigen::Vector3d& b) { return {b[0], b[1], b[2]}; }

/// Returns how far the triangle's corner order is rotated against CGAL's.
int rotation(const mesh::Surface& surface, const Patch& patch, int triangle,
             Mesh::Face_index face) {
  const auto first = patch.mesh.point(patch.mesh.source(patch.mesh.halfedge(face)));
  for (int i = 0; i < 3; ++i) {
    const int corner = surface.triangles[std::size_t(triangle)][i];
    const auto& p = surface.points[std::size_t(surface.weld[std::size_t(corner)])];
    if (first == Kernel::Point_3(p.x(), p.y(), p.z())) return i;
  }
  throw std::logic_error("no common corner");
}

Eigen::Vector3d rotated(const Eigen::Vector3d& b, int by) {
  return {b[by], b[(by + 1) % 3], b[(by + 2) % 3]};
}

}  // namespace

double reference_distance(const mesh::Surface& surface, const plan::Regions& regions, int dip,
                          const SurfacePoint& point, double limit_mm) {
  const Patch patch(surface, point.place, limit_mm);
  Paths paths(patch.mesh);
  const auto face = patch.faces.at(point.triangle);
  const int turn = rotation(surface, patch, point.triangle, face);
  paths.add_source_point(face, to_cgal(rotated(point.barycentric, turn)));
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [triangle, target] : patch.faces) {
    const auto& fragments = regions.fragments;
    const int target_turn = rotation(surface, patch, triangle, target);
    for (std::size_t f = fragments.begin[std::size_t(triangle)];
         f < fragments.begin[std::size_t(triangle) + 1]; ++f) {
      if (fragments.all[f].dip != dip) continue;
      const auto polygon = fragments.polygon(f);
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto& a = polygon[i];
        const auto& b = polygon[(i + 1) % polygon.size()];
        const Eigen::Vector3d from = plan::place_of(surface, triangle, a);
        const Eigen::Vector3d to = plan::place_of(surface, triangle, b);
        const int steps = 1 + static_cast<int>((to - from).norm() / kSampleMm);
        for (int s = 0; s < steps; ++s) {
          const double x = double(s) / steps;
          if (((1 - x) * from + x * to - point.place).norm() > std::min(limit_mm, least)) continue;
          const Eigen::Vector3d at = (1 - x) * a + x * b;
          const auto found =
              paths.shortest_distance_to_source_points(target, to_cgal(rotated(at, target_turn)));
          if (found.first >= 0) least = std::min(least, double(found.first));
        }
      }
    }
  }
  return least <= limit_mm ? least : std::numeric_limits<double>::infinity();
}

}  // namespace hydroprint::testing
