#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sim/velocity/film_mesh.h"

namespace hydroprint::velocity {

/// Returns the six nodes of a triangle: corners 0, 1, 2, then the midpoints of the edges opposite
/// them.
[[nodiscard]] std::array<int, 6> nodes_of(const FilmMesh& mesh, std::size_t triangle);

/// Returns the position of a node, mm.
[[nodiscard]] Eigen::Vector2d place_of(const FilmMesh& mesh, std::size_t node);

/// Returns twice the area of a triangle of the mesh, mm^2.
[[nodiscard]] double twice_area_mm2(const FilmMesh& mesh, std::size_t triangle);

/// A quadrature point: its position in the triangle, and its weight as a share of the area.
struct QuadraturePoint {
  Eigen::Vector3d barycentric;
  double weight;
};

/// Returns Dunavant's six points, which are exact for polynomials of degree four on a triangle.
[[nodiscard]] const std::array<QuadraturePoint, 6>& quadrature();

/// Returns the values of the six shape functions at a point of a triangle.
[[nodiscard]] Eigen::Matrix<double, 6, 1> shape_values(const Eigen::Vector3d& barycentric);

/// Returns the gradients of the shape functions at a point, 1/mm, one per row.
[[nodiscard]] Eigen::Matrix<double, 6, 2> shape_gradients(const FilmMesh& mesh,
                                                          std::size_t triangle,
                                                          const Eigen::Vector3d& barycentric);

/// Vector of the x and y components for a triangle's six nodes (in the order of nodes_of()), and
/// matrix with a row and a column for each component.
using ElementVector = Eigen::Matrix<double, 12, 1>;
using ElementMatrix = Eigen::Matrix<double, 12, 12>;

/// Returns the mass matrix: the integral of u . v over a triangle of unit area.
[[nodiscard]] const ElementMatrix& unit_mass();

/// Returns an order of the nodes with low fill for matrices on six-node triangles (approximate
/// minimum degree).
[[nodiscard]] std::vector<int> elimination_order(const FilmMesh& mesh);

/// Numbers the nodes without a prescribed value in elimination order.
struct Unknowns {
  std::vector<int> of_node;  ///< -1: prescribed
  int count = 0;

  /// @param fixed  for each node, the prescribed value, or NaN where it is unknown
  Unknowns(const FilmMesh& mesh, const std::vector<Eigen::Vector2d>& fixed);
};

}  // namespace hydroprint::velocity
