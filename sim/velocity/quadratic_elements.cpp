#include "sim/velocity/quadratic_elements.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <cmath>

namespace hydroprint::velocity {

std::array<int, 6> nodes_of(const FilmMesh& mesh, std::size_t triangle) {
  const auto corner_count = static_cast<int>(mesh.vertices_mm.size());
  const Eigen::Vector3i& v = mesh.triangles[triangle];
  const Eigen::Vector3i& e = mesh.triangle_edges[triangle];
  return {v[0], v[1], v[2], corner_count + e[0], corner_count + e[1], corner_count + e[2]};
}

Eigen::Vector2d place_of(const FilmMesh& mesh, std::size_t node) {
  const std::size_t corner_count = mesh.vertices_mm.size();
  if (node < corner_count) return mesh.vertices_mm[node];
  const auto [a, b] = mesh.edges[node - corner_count];
  return 0.5 * (mesh.vertices_mm[a] + mesh.vertices_mm[b]);
}

double twice_area_mm2(const FilmMesh& mesh, std::size_t triangle) {
  const Eigen::Vector3i& v = mesh.triangles[triangle];
  const Eigen::Vector2d ab = mesh.vertices_mm[v[1]] - mesh.vertices_mm[v[0]];
  const Eigen::Vector2d ac = mesh.vertices_mm[v[2]] - mesh.vertices_mm[v[0]];
  return ab.x() * ac.y() - ab.y() * ac.x();
}

const std::array<QuadraturePoint, 6>& quadrature() {
  static const std::array<QuadraturePoint, 6> points = [] {
    // One of the three coordinates (the other two are equal), and the weight.
    constexpr std::array<std::array<double, 2>, 2> kOrbits = {
        {{0.108103018168070, 0.223381589678011}, {0.816847572980459, 0.109951743655322}}};
    std::array<QuadraturePoint, 6> out;
    for (int i = 0; i < 6; ++i) {
      const auto [apex, weight] = kOrbits[i / 3];
      out[i] = {Eigen::Vector3d::Constant((1 - apex) / 2), weight};
      out[i].barycentric[i % 3] = apex;
    }
    return out;
  }();
  return points;
}

Eigen::Matrix<double, 6, 1> shape_values(const Eigen::Vector3d& l) {
  Eigen::Matrix<double, 6, 1> out;
  for (int i = 0; i < 3; ++i) {
    out[i] = l[i] * (2 * l[i] - 1);
    out[3 + i] = 4 * l[(i + 1) % 3] * l[(i + 2) % 3];
  }
  return out;
}

Eigen::Matrix<double, 6, 2> shape_gradients(const FilmMesh& mesh, std::size_t triangle,
                                            const Eigen::Vector3d& l) {
  const Eigen::Vector3i& v = mesh.triangles[triangle];
  const double twice_area = twice_area_mm2(mesh, triangle);
  Eigen::Matrix<double, 3, 2> corner;  // gradients of the barycentric coordinates
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d along =
        mesh.vertices_mm[v[(i + 2) % 3]] - mesh.vertices_mm[v[(i + 1) % 3]];
    corner.row(i) << -along.y() / twice_area, along.x() / twice_area;
  }
  Eigen::Matrix<double, 6, 2> out;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    out.row(i) = (4 * l[i] - 1) * corner.row(i);
    out.row(3 + i) = 4 * (l[j] * corner.row(k) + l[k] * corner.row(j));
  }
  return out;
}

const ElementMatrix& unit_mass() {
  static const ElementMatrix mass = [] {
    ElementMatrix m = ElementMatrix::Zero();
    for (const QuadraturePoint& point : quadrature()) {
      const auto n = shape_values(point.barycentric);
      for (int i = 0; i < 12; ++i) {
        for (int j = i % 2; j < 12; j += 2) m(i, j) += point.weight * n[i / 2] * n[j / 2];
      }
    }
    return m;
  }();
  return mass;
}

std::vector<int> elimination_order(const FilmMesh& mesh) {
  const auto size = static_cast<int>(mesh.node_count());
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(21 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int row : nodes_of(mesh, t)) {
      for (const int column : nodes_of(mesh, t)) {
        if (column <= row) entries.emplace_back(row, column, 1.0);
      }
    }
  }
  Eigen::SparseMatrix<double> graph(size, size);
  graph.setFromTriplets(entries.begin(), entries.end());
  Eigen::AMDOrdering<int>::PermutationType permutation;
  Eigen::AMDOrdering<int>()(graph.selfadjointView<Eigen::Lower>(), permutation);
  const auto& order = permutation.indices();
  return {order.data(), order.data() + order.size()};
}

Unknowns::Unknowns(const FilmMesh& mesh, const std::vector<Eigen::Vector2d>& fixed)
    : of_node(fixed.size(), -1) {
  for (const int n : mesh.elimination_order) {
    if (std::isnan(fixed[n].x())) of_node[n] = count++;
  }
}

}  // namespace hydroprint::velocity
