#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace hydroprint::image {

/// The samples that may be visited: columns [x0, x1), rows [y0, y1). Sample (i, j) is at (i + 1/2,
/// j + 1/2), y down.
struct Window {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

using Corners = std::array<Eigen::Vector2d, 3>;

namespace raster_detail {

__extension__ typedef __int128 Int128;

/// Corners are rounded to 1/1024 of a sample; all later computation is exact.
inline constexpr int kOne = 1024;
/// Corners within kNarrow samples of the origin fit 64-bit edge functions, within kWide 128-bit
/// ones.
inline constexpr double kNarrow = 1 << 19;
inline constexpr double kWide = static_cast<double>(std::int64_t{1} << 40);

template <class Int>
Int floor_div(Int a, Int b) {  // b > 0
  const Int q = a / b;
  return q - (a % b < 0 ? 1 : 0);
}

/// One edge, oriented so that its edge function is positive on the inner side.
template <class Int>
struct Edge {
  Int ax, ay, dx, dy;
  Int threshold;  ///< 0 for top and left edges, which own the samples exactly on them, else 1
  Int per_row;    ///< change of the edge function from one sample of a row to the next
  double reciprocal;

  Edge(Int ax_, Int ay_, Int bx, Int by)
      : ax(ax_),
        ay(ay_),
        dx(bx - ax_),
        dy(by - ay_),
        threshold(dy < 0 || (dy == 0 && dx > 0) ? 0 : 1),
        per_row((dy < 0 ? -dy : dy) * kOne),
        reciprocal(1 / static_cast<double>(per_row)) {}

  /// Computes floor(k / per_row) exactly. Multiplies by the reciprocal, because 64-bit division is
  /// slow, and then corrects the result, which is off by at most one.
  Int rows(Int k) const {
    if constexpr (sizeof(Int) > sizeof(std::int64_t)) {
      return floor_div<Int>(k, per_row);
    } else {
      const Int guess = static_cast<Int>(static_cast<double>(k) * reciprocal);
      const Int rest = k - guess * per_row;
      return guess + (rest >= per_row ? 1 : 0) - (rest < 0 ? 1 : 0);
    }
  }

  /// Narrows [begin, end) to the samples of row y on the inner side.
  void narrow(Int y, Int& begin, Int& end) const {
    const Int half = kOne / 2;
    const Int k = dx * (y * kOne + half - ay) - threshold + dy * (ax - half);
    if (dy == 0) {
      if (k < 0) end = begin;
    } else if (dy > 0) {
      end = std::min(end, rows(k) + 1);
    } else {
      begin = std::max(begin, -rows(k));
    }
  }
};

template <class Int, class Span>
void scan(const Corners& corners, const Window& window, Span&& span) {
  std::array<Int, 3> x, y;
  for (int i = 0; i < 3; ++i) {
    x[i] = static_cast<Int>(std::round(corners[i].x() * kOne));
    y[i] = static_cast<Int>(std::round(corners[i].y() * kOne));
  }
  const Int area = (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]);
  if (area == 0) return;
  if (area < 0) {
    std::swap(x[1], x[2]);
    std::swap(y[1], y[2]);
  }
  const std::array<Edge<Int>, 3> edges = {Edge<Int>(x[0], y[0], x[1], y[1]),
                                          Edge<Int>(x[1], y[1], x[2], y[2]),
                                          Edge<Int>(x[2], y[2], x[0], y[0])};
  const auto [low, high] = std::minmax({y[0], y[1], y[2]});
  const Int half = kOne / 2;
  const Int first = std::max<Int>(window.y0, -floor_div<Int>(half - low, kOne));
  const Int last = std::min<Int>(window.y1 - 1, floor_div<Int>(high - half, kOne));
  for (Int row = first; row <= last; ++row) {
    Int begin = window.x0, end = window.x1;
    for (const Edge<Int>& edge : edges) edge.narrow(row, begin, end);
    if (begin < end) {
      span(static_cast<int>(row), static_cast<int>(begin), static_cast<int>(end));
    }
  }
}

inline double reach(const Corners& corners) {
  double reach = 0;
  for (const auto& corner : corners) {
    if (!corner.allFinite()) return HUGE_VAL;
    reach = std::max(reach, corner.cwiseAbs().maxCoeff());
  }
  return reach;
}

}  // namespace raster_detail

/// Calls span(y, x_begin, x_end) for every row of samples inside a triangle of either orientation.
/// Samples exactly on an edge belong to the triangle for which it is a top or left edge, so that
/// triangles sharing an edge (equal corners) visit each sample exactly once. Triangles without
/// area, or with a corner that is not finite or further than 2^40 from the origin, have no samples.
template <class Span>
void for_each_span(const Corners& corners, const Window& window, Span&& span) {
  const double reach = raster_detail::reach(corners);
  if (reach <= raster_detail::kNarrow) {
    raster_detail::scan<std::int64_t>(corners, window, span);
  } else if (reach <= raster_detail::kWide) {
    raster_detail::scan<raster_detail::Int128>(corners, window, span);
  }
}

/// Barycentric coordinates as an affine function of position; constructed once per triangle.
class BarycentricMap {
 public:
  explicit BarycentricMap(const Corners& corners) : origin_(corners[0]) {
    const Eigen::Vector2d a = corners[1] - corners[0], b = corners[2] - corners[0];
    const double area = a.x() * b.y() - a.y() * b.x();
    if (area == 0 || !std::isfinite(area)) return;
    per_x_ = Eigen::Vector3d((a.y() - b.y()) / area, b.y() / area, -a.y() / area);
    per_y_ = Eigen::Vector3d((b.x() - a.x()) / area, -b.x() / area, a.x() / area);
  }

  /// May lie slightly outside [0, 1] at samples that are inside only because the corners are
  /// rounded.
  [[nodiscard]] Eigen::Vector3d at(double x, double y) const {
    return Eigen::Vector3d::UnitX() + per_x_ * (x - origin_.x()) + per_y_ * (y - origin_.y());
  }
  [[nodiscard]] const Eigen::Vector3d& per_x() const { return per_x_; }
  [[nodiscard]] const Eigen::Vector3d& per_y() const { return per_y_; }

 private:
  Eigen::Vector2d origin_;
  Eigen::Vector3d per_x_ = Eigen::Vector3d::Zero(), per_y_ = Eigen::Vector3d::Zero();
};

/// Calls sample(x, y, barycentric) for every sample inside a triangle, as for_each_span() finds
/// them.
template <class Sample>
void for_each_sample(const Corners& corners, const Window& window, Sample&& sample) {
  const BarycentricMap map(corners);
  for_each_span(corners, window, [&](int y, int begin, int end) {
    for (int x = begin; x < end; ++x) sample(x, y, map.at(x + 0.5, y + 0.5));
  });
}

}  // namespace hydroprint::image
