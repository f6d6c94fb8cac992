#include "sim/velocity/locator.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/check.h"

namespace hydroprint::velocity {
namespace {

constexpr double kCell_mm = 2.0;
constexpr int kMostSteps = 8;  ///< maximum steps of a walk; for longer walks the grid is faster

struct Box {
  Eigen::Vector2d low, high;
};

Box box_of(const FilmMesh& mesh, const Eigen::Vector3i& triangle) {
  const auto& v = mesh.vertices_mm;
  return {v[triangle[0]].cwiseMin(v[triangle[1]]).cwiseMin(v[triangle[2]]),
          v[triangle[0]].cwiseMax(v[triangle[1]]).cwiseMax(v[triangle[2]])};
}

/// Returns the point of the triangle nearest to an outside point, in barycentric coordinates.
Eigen::Vector3d nearest_in(const Eigen::Vector2d& p, const Eigen::Vector2d& origin,
                           const Eigen::Matrix2d& edges, double& square_mm2) {
  const std::array<Eigen::Vector2d, 3> corner = {origin, origin + edges.col(0),
                                                 origin + edges.col(1)};
  square_mm2 = std::numeric_limits<double>::infinity();
  Eigen::Vector3d best = Eigen::Vector3d::UnitX();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const Eigen::Vector2d along = corner[j] - corner[i];
    const double length2 = along.squaredNorm();
    const double t = length2 > 0 ? std::clamp((p - corner[i]).dot(along) / length2, 0.0, 1.0) : 0.0;
    const double square = (corner[i] + t * along - p).squaredNorm();
    if (square >= square_mm2) continue;
    square_mm2 = square;
    best.setZero();
    best[i] = 1 - t;
    best[j] = t;
  }
  return best;
}

}  // namespace

Locator::Locator(const FilmMesh& mesh) {
  HP_CHECK(mesh.triangle_edges.size() == mesh.triangles.size());
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
  for (const Eigen::Vector2d& p : mesh.vertices_mm) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  if (mesh.triangles.empty()) return;
  origin_mm_ = low.array() - kReach_mm;
  const Eigen::Vector2d size = (high - low).array() + 2 * kReach_mm;
  columns_ = static_cast<int>(size.x() / kCell_mm) + 1;
  rows_ = static_cast<int>(size.y() / kCell_mm) + 1;

  std::vector<std::array<int, 2>> sides(mesh.edges.size(), {-1, -1});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int e : mesh.triangle_edges[t])
      sides[e][sides[e][0] < 0 ? 0 : 1] = static_cast<int>(t);
  }
  triangles_.reserve(mesh.triangles.size());
  edges_mm_.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Eigen::Vector3i& v = mesh.triangles[t];
    Eigen::Matrix2d& edges = edges_mm_.emplace_back();
    edges << mesh.vertices_mm[v[1]] - mesh.vertices_mm[v[0]],
        mesh.vertices_mm[v[2]] - mesh.vertices_mm[v[0]];
    Eigen::Vector3i across;
    for (int i = 0; i < 3; ++i) {
      const auto [a, b] = sides[mesh.triangle_edges[t][i]];
      across[i] = a == static_cast<int>(t) ? b : a;
    }
    triangles_.push_back({mesh.vertices_mm[v[0]], edges.inverse(), across});
  }

  const auto fill = [&](double margin_mm, const std::vector<int>& which, std::vector<int>& start,
                        std::vector<int>& list) {
    const auto for_cells = [&](int t, auto&& visit) {
      const Box box = box_of(mesh, mesh.triangles[t]);
      const auto clamp_cell = [](double at, int count) {
        return std::clamp(static_cast<int>(at / kCell_mm), 0, count - 1);
      };
      const Eigen::Vector2d first = box.low.array() - margin_mm - origin_mm_.array();
      const Eigen::Vector2d last = box.high.array() + margin_mm - origin_mm_.array();
      for (int r = clamp_cell(first.y(), rows_); r <= clamp_cell(last.y(), rows_); ++r) {
        for (int c = clamp_cell(first.x(), columns_); c <= clamp_cell(last.x(), columns_); ++c) {
          visit(r * columns_ + c);
        }
      }
    };
    start.assign(static_cast<std::size_t>(columns_) * rows_ + 1, 0);
    for (const int t : which) for_cells(t, [&](int cell) { ++start[cell + 1]; });
    for (std::size_t c = 1; c < start.size(); ++c) start[c] += start[c - 1];
    list.resize(start.back());
    std::vector<int> next(start.begin(), start.end() - 1);
    for (const int t : which) for_cells(t, [&](int cell) { list[next[cell]++] = t; });
  };
  std::vector<int> all(mesh.triangles.size()), border;
  for (int t = 0; t < static_cast<int>(all.size()); ++t) {
    all[t] = t;
    const Eigen::Vector3i& edges = mesh.triangle_edges[t];
    const bool at_border = std::any_of(
        edges.begin(), edges.end(), [&](int e) { return mesh.edge_kind[e] != EdgeKind::kInner; });
    if (at_border) border.push_back(t);
  }
  fill(0, all, inner_start_, inner_);
  fill(kReach_mm, border, near_start_, near_);
}

bool Locator::walk(int triangle, const Eigen::Vector2d& point_mm, Place& place) const {
  for (int step = 0; step < kMostSteps && triangle >= 0; ++step) {
    if (holds(triangle, point_mm, place)) return true;
    const Eigen::Vector3d& b = place.barycentric;
    const int outside = b[0] <= b[1] ? (b[0] <= b[2] ? 0 : 2) : (b[1] <= b[2] ? 1 : 2);
    triangle = triangles_[triangle].neighbours[outside];
  }
  return false;
}

bool Locator::holds(int triangle, const Eigen::Vector2d& point_mm, Place& place) const {
  const Corners& corners = triangles_[triangle];
  const Eigen::Vector2d b = corners.to_barycentric * (point_mm - corners.origin_mm);
  const double first = 1 - b.x() - b.y();
  place.triangle = triangle;
  place.barycentric = {first, b.x(), b.y()};
  place.outside_mm = 0;
  // This is the innermost operation of a simulation. Eigen's minCoeff() would not be inlined here.
  constexpr double kSlack = -1e-10;
  return (first >= kSlack) & (b.x() >= kSlack) & (b.y() >= kSlack);
}

Locator::Place Locator::find(const Eigen::Vector2d& point_mm, int guess) const {
  Place place;
  if (walk(guess, point_mm, place)) return place;
  const Eigen::Vector2d at = (point_mm - origin_mm_) / kCell_mm;
  if (!(at.x() >= 0 && at.y() >= 0 && at.x() < columns_ && at.y() < rows_)) return {};
  const int cell = static_cast<int>(at.y()) * columns_ + static_cast<int>(at.x());
  for (int i = inner_start_[cell]; i < inner_start_[cell + 1]; ++i) {
    if (holds(inner_[i], point_mm, place)) return place;
  }
  return find_nearest(point_mm, cell);
}

Locator::Place Locator::find_nearest(const Eigen::Vector2d& point_mm, int cell) const {
  Place place;
  double best_mm2 = kReach_mm * kReach_mm;
  for (int i = near_start_[cell]; i < near_start_[cell + 1]; ++i) {
    double square_mm2 = 0;
    const Eigen::Vector3d barycentric =
        nearest_in(point_mm, triangles_[near_[i]].origin_mm, edges_mm_[near_[i]], square_mm2);
    if (square_mm2 > best_mm2) continue;
    best_mm2 = square_mm2;
    place = {near_[i], barycentric, std::sqrt(square_mm2)};
  }
  return place;
}

}  // namespace hydroprint::velocity
