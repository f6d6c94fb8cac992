#include "sim/mesh/weld.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "sim/base/check.h"

namespace hydroprint::mesh {
namespace {

using Cell = Eigen::Matrix<std::int64_t, 3, 1>;

/// Points by grid cell, in a hash table. Cells in the same slot share a chain; the distance test
/// separates them. Only representatives are stored, so a cell with a side of four tolerances
/// contains a bounded number of points.
class Grid {
 public:
  Grid(const std::vector<Eigen::Vector3d>& points, double tolerance)
      : points_(points),
        tolerance_(tolerance),
        cell_mm_(4 * tolerance),
        mask_(std::bit_ceil(2 * points.size() + 1) - 1),
        heads_(mask_ + 1, -1),
        next_(points.size(), -1) {
    if (points.empty()) return;
    origin_ = points.front();
    for (const auto& p : points) origin_ = origin_.cwiseMin(p);
  }

  /// Returns the first representative within tolerance of point i, or -1.
  [[nodiscard]] int find(std::size_t i) const {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(tolerance_);
    const Cell low = cell(points_[i] - reach);
    const Cell high = cell(points_[i] + reach);
    int found = -1;
    for (auto x = low.x(); x <= high.x(); ++x)
      for (auto y = low.y(); y <= high.y(); ++y)
        for (auto z = low.z(); z <= high.z(); ++z) found = first_of(found, search({x, y, z}, i));
    return found;
  }

  void add(std::size_t i) {
    auto& head = heads_[slot(cell(points_[i]))];
    next_[i] = head;
    head = static_cast<int>(i);
  }

 private:
  static int first_of(int a, int b) { return a < 0 ? b : b < 0 ? a : std::min(a, b); }

  [[nodiscard]] Cell cell(const Eigen::Vector3d& p) const {
    if (!(cell_mm_ > 0)) return Cell::Zero();
    return ((p - origin_) / cell_mm_).array().floor().matrix().cast<std::int64_t>();
  }

  [[nodiscard]] std::size_t slot(const Cell& c) const {
    std::uint64_t hash = 0;
    for (int k = 0; k < 3; ++k) {
      hash = (hash ^ static_cast<std::uint64_t>(c[k])) * 0x9e3779b97f4a7c15ULL;
      hash ^= hash >> 32;
    }
    return hash & mask_;
  }

  [[nodiscard]] int search(const Cell& c, std::size_t i) const {
    int found = -1;
    for (int j = heads_[slot(c)]; j >= 0; j = next_[static_cast<std::size_t>(j)])
      if ((points_[static_cast<std::size_t>(j)] - points_[i]).norm() <= tolerance_)
        found = first_of(found, j);
    return found;
  }

  const std::vector<Eigen::Vector3d>& points_;
  double tolerance_;
  double cell_mm_;
  std::size_t mask_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::vector<int> heads_;
  std::vector<int> next_;
};

}  // namespace

double diagonal(const std::vector<Eigen::Vector3d>& points) {
  if (points.empty()) return 0;
  Eigen::Vector3d low = points.front();
  Eigen::Vector3d high = points.front();
  for (const auto& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

Eigen::Vector3d far_centre_mm(const std::vector<Eigen::Vector3d>& points) {
  constexpr double kFar_mm = 1e4;
  Eigen::AlignedBox3d box;
  for (const auto& p : points) box.extend(p);
  if (box.isEmpty()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d centre = box.center();
  const bool far = centre.norm() > kFar_mm && centre.norm() > 10 * box.sizes().maxCoeff();
  return far ? centre : Eigen::Vector3d::Zero();
}

double nothing_mm(const std::vector<Eigen::Vector3d>& points) {
  double largest = 0;
  for (const auto& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  const double step = std::numeric_limits<double>::epsilon() * largest;
  return std::max(kNothing * diagonal(points), 4 * step);
}

std::vector<int> weld_points(const std::vector<Eigen::Vector3d>& points, double tolerance) {
  HP_CHECK(tolerance >= 0);
  Grid grid(points, tolerance);
  std::vector<int> weld(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const int found = grid.find(i);
    weld[i] = found < 0 ? static_cast<int>(i) : found;
    if (found < 0) grid.add(i);
  }
  return weld;
}

bool is_degenerate(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                   double tolerance) {
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  return (b - a).cross(c - a).norm() <= tolerance * longest;
}

}  // namespace hydroprint::mesh
