#include "sim/velocity/velocity.h"

#include <Eigen/SparseCholesky>
#include <array>
#include <cmath>
#include <limits>

#include "sim/base/check.h"
#include "sim/velocity/quadratic_elements.h"

namespace hydroprint::velocity {
namespace {

using Local = Eigen::Matrix<double, 6, 6>;

/// Stiffness of one quadratic triangle, in closed form from that of the linear triangle,
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

}  // namespace

VelocityField::VelocityField(FilmMesh mesh, std::vector<Eigen::Vector2d> nodes)
    : nodes_(std::move(nodes)) {
  Locator locator(mesh);
  film_ = std::make_shared<const Film>(Film{std::move(mesh), std::move(locator)});
}

std::shared_ptr<const VelocityField::Film> VelocityField::no_film() {
  static const auto none = std::make_shared<const Film>();
  return none;
}

VelocityField VelocityField::with(std::vector<Eigen::Vector2d> nodes) const {
  HP_CHECK(nodes.size() == nodes_.size());
  VelocityField other = *this;
  other.nodes_ = std::move(nodes);
  return other;
}

bool VelocityField::at(const Eigen::Vector2d& point_mm, double reach_mm,
                       Eigen::Vector2d& velocity) const {
  int triangle = -1;
  return at(point_mm, reach_mm, velocity, triangle);
}

bool VelocityField::at(const Eigen::Vector2d& point_mm, double reach_mm, Eigen::Vector2d& velocity,
                       int& triangle) const {
  const Locator::Place place = film_->locator.find(point_mm, triangle);
  if (place.triangle < 0 || place.outside_mm > reach_mm) return false;
  triangle = place.triangle;
  velocity = value(place);
  return true;
}

double VelocityField::nearest(const Eigen::Vector2d& point_mm, Eigen::Vector2d& velocity) const {
  const Locator::Place place = film_->locator.find(point_mm);
  velocity = place.triangle < 0 ? Eigen::Vector2d(0, 0) : value(place);
  return place.triangle < 0 ? kNoFilm_mm : place.outside_mm;
}

Eigen::Vector2d VelocityField::value(const Locator::Place& place) const {
  const Eigen::Vector3d& l = place.barycentric;
  const auto node = nodes_of(film_->mesh, place.triangle);
  return l[0] * (2 * l[0] - 1) * nodes_[node[0]] + l[1] * (2 * l[1] - 1) * nodes_[node[1]] +
         l[2] * (2 * l[2] - 1) * nodes_[node[2]] +
         4 * (l[1] * l[2] * nodes_[node[3]] + l[2] * l[0] * nodes_[node[4]] +
              l[0] * l[1] * nodes_[node[5]]);
}

std::vector<Eigen::Vector2d> boundary_velocities(const FilmMesh& mesh,
                                                 const waterline::PullIndex& pulls) {
  HP_CHECK(mesh.edge_kind.size() == mesh.edges.size());
  constexpr double kInwards = 0.02;  ///< share of an edge's length, to sample each side of a corner
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
  HP_CHECK(fixed.size() == mesh.node_count());
  HP_CHECK(mesh.elimination_order.size() == mesh.node_count());
  const Unknowns unknowns(mesh, fixed);
  const auto& [unknown, count] = unknowns;
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
  const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>>
      factor(matrix);
  if (factor.info() != Eigen::Success) {
    return fail(Code::kInternal,
                "velocity: the film mesh gives a singular matrix. Please report this");
  }
  const Eigen::MatrixX2d solution = factor.solve(load);
  for (std::size_t n = 0; n < fixed.size(); ++n) {
    if (unknown[n] >= 0) velocity[n] = solution.row(unknown[n]).transpose();
  }
  return velocity;
}

}  // namespace hydroprint::velocity
