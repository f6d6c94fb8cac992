#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sim/base/result.h"
#include "sim/film/outline.h"
#include "sim/velocity/sizing.h"
#include "sim/waterline/waterlines.h"

namespace hydroprint::velocity {

/// The kinds of edges of the film mesh, by the region on their other side.
enum class EdgeKind : unsigned char {
  kInner,      ///< more film
  kVat,        ///< the film's clamped edge, Gamma_v
  kWaterline,  ///< the object, Gamma_s
};

/// The floating film at one immersion as triangles with six nodes each. The nodes are first the
/// vertices, then the midpoints of the edges (node vertices_mm.size() + e for edge e).
struct FilmMesh {
  std::vector<Eigen::Vector2d> vertices_mm;
  std::vector<Eigen::Vector3i> triangles;       ///< counter-clockwise
  std::vector<Eigen::Vector3i> triangle_edges;  ///< edge i of a triangle lies opposite corner i
  std::vector<std::array<int, 2>> edges;
  std::vector<EdgeKind> edge_kind;
  /// All nodes, in an order that produces little fill when a matrix is factored.
  std::vector<int> elimination_order;

  [[nodiscard]] std::size_t node_count() const { return vertices_mm.size() + edges.size(); }
};

/// Resolution of the film mesh. The mesh of section 4.4 (1 mm at the waterline, up to 1 cm2 inside,
/// linear elements) alone causes errors of up to 1.2 mm on the far side of a sphere.
struct MeshOptions {
  Sizing::Options size;
  double spacing_mm = 3.0;      ///< distance of mesh vertices along the waterline
  double tolerance_mm = 0.015;  ///< largest distance of the mesh edges there from the waterline
  double least_mm = 0.1;        ///< smaller features of the waterline are smoothed
};

/// Meshes the film between its edge and the waterline. Uses a constrained Delaunay triangulation,
/// refined to angles of at least 30 degrees (where the boundary permits) and to the sizing field.
/// Neither walls nor gaps below 0.1 mm, whose curves may also touch or cross, refine it further.
/// @return kInvalidArgument, MESH_UNBOUNDED if the mesh needs far more vertices than the length of
///         the waterline and the coarsest size imply
[[nodiscard]] Result<FilmMesh> mesh_film(const film::Outline& outline,
                                         const waterline::Waterline& line,
                                         const MeshOptions& options);

}  // namespace hydroprint::velocity
