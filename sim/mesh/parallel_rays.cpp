#include "sim/mesh/parallel_rays.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace hydroprint::mesh {
namespace {

using Eigen::Vector2d;

/// A square of the quadtree is not divided if it has at most this many triangles, after so many
/// divisions, or if its parts would have this many times as many triangles together.
constexpr std::size_t kFew = 12;
constexpr int kMostDivisions = 16;
constexpr std::size_t kMostGrowth = 3;
/// All squares together have at most this many entries per triangle.
constexpr std::size_t kMostEntries = 32;
/// Squares are this much larger for the test of overlap, so that rounding misses no triangle.
constexpr double kLarger = 1 + 1e-9;

double cross_product(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Returns whether a point is left of an edge that passes its height. An edge includes its lower
/// end, but not its upper one. The result is the same for both directions of the edge, so
/// triangles that share it leave no gap and do not overlap.
bool is_left_of(const Vector2d& p, const Vector2d& from, const Vector2d& to) {
  if ((from.y() <= p.y()) == (to.y() <= p.y())) return false;
  const Vector2d& low = from.y() <= p.y() ? from : to;
  const Vector2d& high = from.y() <= p.y() ? to : from;
  return p.x() < low.x() + (p.y() - low.y()) / (high.y() - low.y()) * (high.x() - low.x());
}

/// Coordinates in which the rays are parallel to the last axis: far from the directions of most
/// models.
Eigen::Matrix3d frame() {
  const Eigen::Vector3d ray = Eigen::Vector3d(0.3141, 0.2718, 0.9097).normalized();
  return Eigen::Quaterniond::FromTwoVectors(ray, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

}  // namespace

struct ParallelRays::Impl {
  /// A triangle as seen along the rays.
  struct Seen {
    std::array<Vector2d, 3> corners;  ///< counter-clockwise
    int sign = 1;                     ///< -1: seen from its front
    Vector2d slope = Vector2d::Zero();
    double depth_at_first = 0;

    [[nodiscard]] bool contains(const Vector2d& p) const {
      return is_left_of(p, corners[0], corners[1]) !=
             (is_left_of(p, corners[1], corners[2]) != is_left_of(p, corners[2], corners[0]));
    }
    [[nodiscard]] double depth(const Vector2d& p) const {
      return depth_at_first + slope.dot(p - corners[0]);
    }
  };

  struct Square {
    Vector2d middle;
    double half = 0;
    int divisions = 0;
    int first_part = -1;  ///< of four squares; -1: not divided
    std::size_t begin = 0, end = 0;
  };

  Eigen::Matrix3d turn = frame();
  std::vector<Seen> triangles;
  std::vector<Square> squares;
  std::vector<int> entries;  ///< indices of triangles, for each square that is not divided

  void add(const Corners& corners) {
    std::array<Eigen::Vector3d, 3> p = {turn * corners[0], turn * corners[1], turn * corners[2]};
    const auto flat = [&](std::size_t k) -> Vector2d { return p[k].head<2>(); };
    const double twice_area = cross_product(flat(1) - flat(0), flat(2) - flat(0));
    if (twice_area == 0) return;
    if (twice_area < 0) std::swap(p[1], p[2]);
    Seen seen;
    seen.corners = {flat(0), flat(1), flat(2)};
    seen.sign = twice_area > 0 ? 1 : -1;
    const Vector2d a = flat(1) - flat(0), b = flat(2) - flat(0);
    const double rise_a = p[1].z() - p[0].z(), rise_b = p[2].z() - p[0].z();
    seen.slope = Vector2d(rise_a * b.y() - rise_b * a.y(), rise_b * a.x() - rise_a * b.x()) /
                 std::abs(twice_area);
    seen.depth_at_first = p[0].z();
    triangles.push_back(seen);
  }

  [[nodiscard]] bool overlap(const Square& square, const Seen& seen) const {
    const double half = kLarger * square.half;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector2d& from = seen.corners[k];
      const Vector2d along = seen.corners[(k + 1) % 3] - from;
      const double slack = half * along.cwiseAbs().sum();
      if (cross_product(along, square.middle - from) < -slack) return false;
    }
    const auto& [a, b, c] = seen.corners;
    const Vector2d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    return ((low - square.middle).array() <= half).all() &&
           ((square.middle - high).array() <= half).all();
  }

  [[nodiscard]] Square whole() const {
    Eigen::AlignedBox2d box;
    for (const Seen& seen : triangles)
      for (const Vector2d& p : seen.corners) box.extend(p);
    return {box.center(), 0.5 * box.sizes().maxCoeff()};
  }

  /// Returns the parts of a square, and the triangles in each of them.
  using Part = std::pair<Square, std::vector<int>>;
  [[nodiscard]] std::array<Part, 4> parts(const Square& square, const std::vector<int>& in) const {
    std::array<Part, 4> out;
    for (int k = 0; k < 4; ++k) {
      auto& [part, members] = out[static_cast<std::size_t>(k)];
      const Vector2d towards((k & 1) != 0 ? 0.5 : -0.5, (k & 2) != 0 ? 0.5 : -0.5);
      part = {square.middle + square.half * towards, 0.5 * square.half, square.divisions + 1};
      for (const int t : in)
        if (overlap(part, triangles[static_cast<std::size_t>(t)])) members.push_back(t);
    }
    return out;
  }

  /// Divides the squares, the larger ones first.
  void divide() {
    std::vector<std::vector<int>> members(1);
    for (std::size_t t = 0; t < triangles.size(); ++t) members[0].push_back(static_cast<int>(t));
    squares.push_back(whole());
    std::size_t sum = triangles.size();
    for (std::size_t s = 0; s < squares.size(); ++s) {
      const std::vector<int> in = std::move(members[s]);
      const bool may_divide = in.size() > kFew && squares[s].divisions < kMostDivisions;
      std::size_t after = kMostGrowth * in.size();
      std::array<Part, 4> divided;
      if (may_divide) {
        divided = parts(squares[s], in);
        after = 0;
        for (const auto& part : divided) after += part.second.size();
      }
      if (after >= kMostGrowth * in.size() ||
          sum + after - in.size() > kMostEntries * triangles.size()) {
        squares[s].begin = entries.size();
        entries.insert(entries.end(), in.begin(), in.end());
        squares[s].end = entries.size();
        continue;
      }
      sum += after - in.size();
      squares[s].first_part = static_cast<int>(squares.size());
      for (auto& [part, of_part] : divided) {
        squares.push_back(part);
        members.push_back(std::move(of_part));
      }
    }
  }

  [[nodiscard]] const Square& square_at(const Vector2d& p) const {
    std::size_t s = 0;
    while (squares[s].first_part >= 0) {
      const Vector2d& middle = squares[s].middle;
      const int k = (p.x() >= middle.x() ? 1 : 0) + (p.y() >= middle.y() ? 2 : 0);
      s = static_cast<std::size_t>(squares[s].first_part + k);
    }
    return squares[s];
  }
};

ParallelRays::ParallelRays(const std::vector<Corners>& triangles)
    : impl_(std::make_unique<Impl>()) {
  for (const Corners& corners : triangles) impl_->add(corners);
  impl_->divide();
}

ParallelRays::~ParallelRays() = default;

int ParallelRays::winding(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d p = impl_->turn * point;
  const Vector2d flat = p.head<2>();
  const Impl::Square& square = impl_->square_at(flat);
  int sum = 0;
  for (std::size_t i = square.begin; i < square.end; ++i) {
    const Impl::Seen& seen = impl_->triangles[static_cast<std::size_t>(impl_->entries[i])];
    if (seen.contains(flat) && seen.depth(flat) > p.z()) sum += seen.sign;
  }
  return sum;
}

}  // namespace hydroprint::mesh
