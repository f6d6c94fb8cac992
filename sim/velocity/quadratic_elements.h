#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sim/velocity/film_mesh.h"

namespace hydroprint::velocity {

/// The six nodes of a triangle: corners 0, 1, 2, then the middles of the edges opposite them.
[[nodiscard]] std::array<int, 6> nodes_of(const FilmMesh& mesh, std::size_t triangle);

/// Where a node lies, mm.
[[nodiscard]] Eigen::Vector2d place_of(const FilmMesh& mesh, std::size_t node);

/// Twice the area of a triangle of the mesh, mm^2.
[[nodiscard]] double twice_area_mm2(const FilmMesh& mesh, std::size_t triangle);

/// A point to integrate at: where in the triangle, and its share of the triangle's area.
struct QuadraturePoint {
  Eigen::Vector3d barycentric;
  double weight;
};

/// Integrates polynomials of the fourth degree over a triangle exactly (Dunavant's six points).
[[nodiscard]] const std::array<QuadraturePoint, 6>& quadrature();

/// The six shape functions at a point of a triangle.
[[nodiscard]] Eigen::Matrix<double, 6, 1> shape_values(const Eigen::Vector3d& barycentric);

/// Their gradients there, 1/mm, one a row.
[[nodiscard]] Eigen::Matrix<double, 6, 2> shape_gradients(const FilmMesh& mesh,
                                                          std::size_t triangle,
                                                          const Eigen::Vector3d& barycentric);

/// x, y of a triangle's six nodes in turn (nodes_of), and one row and column for each.
using ElementVector = Eigen::Matrix<double, 12, 1>;
using ElementMatrix = Eigen::Matrix<double, 12, 12>;

/// Integral of u . v over a triangle of unit area.
[[nodiscard]] const ElementMatrix& unit_mass();

/// Nodes in an order of low fill for matrices on the six-node triangles (approximate minimum
/// degree).
[[nodiscard]] std::vector<int> elimination_order(const FilmMesh& mesh);

/// Numbers the nodes whose value is not prescribed, in the mesh's order of elimination.
struct Unknowns {
  std::vector<int> of_node;  ///< -1: prescribed
  int count = 0;

  /// @param fixed  per node the prescribed value, NaN where it is to be found
  Unknowns(const FilmMesh& mesh, const std::vector<Eigen::Vector2d>& fixed);
};

}  // namespace hydroprint::velocity
