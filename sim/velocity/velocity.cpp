#include "sim/velocity/velocity.h"

#include <Eigen/SparseCholesky>
#include <array>
#include <cmath>
#include <limits>

namespace hydroprint::velocity {
namespace {

using Local = Eigen::Matrix<double, 6, 6>;

/// The six nodes of a triangle: corners 0, 1, 2, then the middles of the edges opposite them.
std::array<int, 6> nodes_of(const FilmMesh& mesh, std::size_t t) {
  const auto corner_count = static_cast<int>(mesh.vertices_mm.size());
  const Eigen::Vector3i& v = mesh.triangles[t];
  const Eigen::Vector3i& e = mesh.triangle_edges[t];
  return {v[0], v[1], v[2], corner_count + e[0], corner_count + e[1], corner_count + e[2]};
}

/// Quadratic stiffness of one triangle, in closed form from the linear one
/// k_ij = area * grad(l_i) . grad(l_j).
Local stiffness(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const std::array<Eigen::Vector2d, 3> edge = {c - b, a - c, b - a};
  const double twice_area = edge[2].x() * -edge[1].y() + edge[2].y() * edge[1].x();
  Eigen::Matrix3d k;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) k(i, j) = edge[i].dot(edge[j]) / (2 * twice_area);
  }
  Local K = Local::Zero();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int m = (i + 2) % 3;
    K(i, i) = k(i, i);
    K(i, j) = K(j, i) = -k(i, j) / 3;
    // Edge node 3 + m lies between corners i and j.
    K(i, 3 + m) = K(3 + m, i) = K(j, 3 + m) = K(3 + m, j) = 4.0 / 3 * k(i, j);
    K(3 + m, 3 + m) = 8.0 / 3 * (k(i, i) + k(j, j) + k(i, j));
    // Edge nodes opposite i and j share corner m; their coupling is that of corners i and j.
    K(3 + i, 3 + j) = K(3 + j, 3 + i) = 8.0 / 3 * k(i, j);
  }
  return K;
}

bool is_free(const Eigen::Vector2d& fixed) { return std::isnan(fixed.x()); }

}  // namespace

VelocityField::VelocityField(FilmMesh mesh, std::vector<Eigen::Vector2d> nodes)
    : mesh_(std::move(mesh)), nodes_(std::move(nodes)), locator_(mesh_) {}

bool VelocityField::at(const Eigen::Vector2d& point_mm, double reach_mm,
                       Eigen::Vector2d& velocity) const {
  Eigen::Vector2d found;
  if (nearest(point_mm, found) > reach_mm) return false;
  velocity = found;
  return true;
}

double VelocityField::nearest(const Eigen::Vector2d& point_mm, Eigen::Vector2d& velocity) const {
  velocity.setZero();
  const Locator::Place place = locator_.find(point_mm);
  if (place.triangle < 0) return kNoFilm_mm;
  const Eigen::Vector3d& l = place.barycentric;
  const auto node = nodes_of(mesh_, place.triangle);
  velocity = l[0] * (2 * l[0] - 1) * nodes_[node[0]] + l[1] * (2 * l[1] - 1) * nodes_[node[1]] +
             l[2] * (2 * l[2] - 1) * nodes_[node[2]] +
             4 * (l[1] * l[2] * nodes_[node[3]] + l[2] * l[0] * nodes_[node[4]] +
                  l[0] * l[1] * nodes_[node[5]]);
  return place.outside_mm;
}

std::vector<Eigen::Vector2d> boundary_velocities(const FilmMesh& mesh,
                                                 const waterline::PullIndex& pulls) {
  constexpr double kInwards = 0.02;  ///< of an edge: off its end, so that a corner has two sides
  const Eigen::Vector2d unknown =
      Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  std::vector<Eigen::Vector2d> fixed(mesh.node_count(), unknown);
  std::vector<int> sides(mesh.vertices_mm.size(), 0);
  const std::size_t corner_count = mesh.vertices_mm.size();
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (mesh.edge_kind[e] != EdgeKind::kWaterline) continue;
    const auto [a, b] = mesh.edges[e];
    const Eigen::Vector2d& p = mesh.vertices_mm[a];
    const Eigen::Vector2d& q = mesh.vertices_mm[b];
    fixed[corner_count + e] = pulls.at(0.5 * (p + q));
    for (const auto& [v, from, to] : {std::tuple{a, p, q}, std::tuple{b, q, p}}) {
      const Eigen::Vector2d side = pulls.at(from + kInwards * (to - from));
      fixed[v] = sides[v]++ == 0 ? side : Eigen::Vector2d(fixed[v] + side);
    }
  }
  for (std::size_t v = 0; v < sides.size(); ++v) {
    if (sides[v] > 1) fixed[v] /= sides[v];
  }
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    if (mesh.edge_kind[e] != EdgeKind::kVat) continue;
    fixed[corner_count + e].setZero();
    for (const int v : mesh.edges[e]) fixed[v].setZero();
  }
  return fixed;
}

Result<std::vector<Eigen::Vector2d>> solve_stokes(const FilmMesh& mesh,
                                                  const std::vector<Eigen::Vector2d>& fixed) {
  std::vector<int> unknown(fixed.size(), -1);
  int count = 0;
  for (std::size_t n = 0; n < fixed.size(); ++n) {
    if (is_free(fixed[n])) unknown[n] = count++;
  }
  std::vector<Eigen::Vector2d> velocity = fixed;
  if (count == 0) return velocity;

  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(21 * mesh.triangles.size());
  Eigen::MatrixX2d load = Eigen::MatrixX2d::Zero(count, 2);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3i& v = mesh.triangles[t];
    const Local K =
        stiffness(mesh.vertices_mm[v[0]], mesh.vertices_mm[v[1]], mesh.vertices_mm[v[2]]);
    const auto node = nodes_of(mesh, t);
    for (int i = 0; i < 6; ++i) {
      const int row = unknown[node[i]];
      if (row < 0) continue;
      for (int j = 0; j < 6; ++j) {
        const int column = unknown[node[j]];
        if (column < 0) {
          load.row(row) -= K(i, j) * fixed[node[j]].transpose();
        } else if (column <= row) {
          entries.emplace_back(row, column, K(i, j));
        }
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor(matrix);
  if (factor.info() != Eigen::Success) {
    return fail(Code::kInternal, "velocity: the film mesh gives a singular matrix");
  }
  const Eigen::MatrixX2d solution = factor.solve(load);
  for (std::size_t n = 0; n < fixed.size(); ++n) {
    if (unknown[n] >= 0) velocity[n] = solution.row(unknown[n]).transpose();
  }
  return velocity;
}

}  // namespace hydroprint::velocity
