#include "sim/ink/ink_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/base/check.h"

namespace hydroprint::ink {
namespace {

using Eigen::Vector2d;

constexpr int kMostCells = 2048;  // along a side
constexpr int kPointsPerCell = 4;
/// Points of the two-point Gauss quadrature, relative to the middle of an interval, as fractions of
/// its length. The quadrature is exact for cubics, such as the integrand along a piece of an edge
/// within one cell.
constexpr std::array<double, 2> kGauss = {-0.28867513459481287, 0.28867513459481287};
constexpr double kOnEdge_cells = 1e-9;
/// If twice the area of a triangle, in square cells, is below this value, rounding errors would be
/// visible in its mean.
constexpr double kFlat_cells2 = 1e-6;

/// One axis of the field, divided at the nodes and at the field's two ends. Strip i in [0, cells]
/// lies between the nodes i and i + 1. Strip -1 lies before the field, strip cells + 1 after it.
struct Axis {
  int cells;

  [[nodiscard]] double begin() const { return 0.5; }
  [[nodiscard]] double end() const { return cells + 0.5; }
  [[nodiscard]] double clamp(double u) const { return std::clamp(u, begin(), end()); }
  [[nodiscard]] int strip(double u) const {
    if (!(u >= begin())) return -1;
    return u >= end() ? cells + 1 : static_cast<int>(u);
  }
  /// Returns the end of strip i, which is the start of strip i + 1.
  [[nodiscard]] double end_of(int i) const { return clamp(i + 1); }
};

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

bool is_ink(double t) { return t >= 0 && t <= kMostInk; }

/// Clamps values that rounding has moved out of [0, 4]; NaN becomes 0.
double rounded_in(double t) { return t >= 0 ? std::min(t, kMostInk) : 0; }

tl::unexpected<Error> not_ink(const InkGrid& grid, std::size_t cell, double t) {
  const auto columns = static_cast<std::size_t>(grid.columns);
  return fail(
      Code::kInvalidArgument,
      fmt::format("ink: the amount in cell ({}, {}), {}, is out of range. Give amounts from 0 to 4",
                  cell % columns, cell / columns, t));
}

}  // namespace

InkGrid ink_grid(const film::Outline& outline, double cell_mm) {
  HP_CHECK(cell_mm > 0);
  HP_CHECK((outline.size_mm().array() > 0).all());
  const auto cells = [&](double size_mm) {
    return static_cast<int>(
        std::clamp(std::round(size_mm / cell_mm), 1.0, static_cast<double>(kMostCells)));
  };
  InkGrid grid;
  grid.low_mm = outline.min_mm;
  grid.columns = cells(outline.size_mm().x());
  grid.rows = cells(outline.size_mm().y());
  grid.cell_mm = outline.size_mm().cwiseQuotient(Vector2d(grid.columns, grid.rows));
  return grid;
}

Result<InkField> InkField::from_means(const InkGrid& grid, const std::vector<double>& means) {
  if (means.size() != grid.count()) {
    return fail(Code::kInvalidArgument,
                fmt::format("ink: {} amounts for a grid of {} cells. Give one amount per cell",
                            means.size(), grid.count()));
  }
  for (std::size_t cell = 0; cell < means.size(); ++cell) {
    if (!is_ink(means[cell])) return not_ink(grid, cell, means[cell]);
  }
  return InkField(grid, means);
}

Result<InkField> InkField::from_function(const InkGrid& grid,
                                         const std::function<double(const Vector2d&)>& t) {
  std::vector<double> means(grid.count());
  for (std::size_t cell = 0; cell < means.size(); ++cell) {
    const auto i = static_cast<int>(cell % static_cast<std::size_t>(grid.columns));
    const auto j = static_cast<int>(cell / static_cast<std::size_t>(grid.columns));
    for (int k = 0; k < kPointsPerCell * kPointsPerCell; ++k) {
      const int row = k / kPointsPerCell;
      const Vector2d point(k % kPointsPerCell, row);
      const Vector2d offset =
          (point + Vector2d::Constant(0.5)) / kPointsPerCell - Vector2d::Constant(0.5);
      const double value = t(grid.centre_mm(i, j) + grid.cell_mm.cwiseProduct(offset));
      if (!is_ink(value)) return not_ink(grid, cell, value);
      means[cell] += value / (kPointsPerCell * kPointsPerCell);
    }
  }
  return InkField(grid, means);
}

InkField::InkField(const InkGrid& grid, const std::vector<double>& means)
    : grid_(grid), stride_(grid.columns + 2) {
  nodes_.resize(static_cast<std::size_t>(stride_) * (grid.rows + 2));
  for (int j = 0; j < grid.rows + 2; ++j) {
    const int row = std::clamp(j - 1, 0, grid.rows - 1);
    for (int i = 0; i < stride_; ++i) {
      const int column = std::clamp(i - 1, 0, grid.columns - 1);
      Node* node = &nodes_[static_cast<std::size_t>(j) * stride_ + i];
      node->t = means[static_cast<std::size_t>(row) * grid.columns + column];
      if (i > 0) node->left = node[-1].left + (node[-1].t + node->t) / 2;
    }
  }
}

Vector2d InkField::in_cells(const Vector2d& point_mm) const {
  return (point_mm - grid_.low_mm).cwiseQuotient(grid_.cell_mm) + Vector2d::Constant(0.5);
}

double InkField::at(const Vector2d& point_mm) const {
  const Axis across{grid_.columns}, up{grid_.rows};
  const Vector2d point = in_cells(point_mm);
  const double u = across.clamp(point.x()), v = up.clamp(point.y());
  const bool is_inside =
      std::abs(u - point.x()) <= kOnEdge_cells && std::abs(v - point.y()) <= kOnEdge_cells;
  if (nodes_.empty() || !is_inside) return 0;
  const int i = static_cast<int>(u), j = static_cast<int>(v);
  const Node* low = &nodes_[static_cast<std::size_t>(j) * stride_ + i];
  const Node* high = low + stride_;
  const double a = u - i, b = v - j;
  return (1 - b) * ((1 - a) * low[0].t + a * low[1].t) + b * ((1 - a) * high[0].t + a * high[1].t);
}

/// Returns the integral of t along the horizontal line through v, from the row's first node to u.
/// The point (u, v) is in strips i and j.
double InkField::to_the_left(int i, int j, double u, double v) const {
  const double a = u - i, b = v - j;
  const auto along = [&](int row) {
    const Node* node = &nodes_[static_cast<std::size_t>(row) * stride_ + i];
    return node->left + a * (node->t + a / 2 * (node[1].t - node->t));
  };
  return (1 - b) * along(j) + b * along(j + 1);
}

/// Returns the integral of t over the region left of an edge; positive if the edge goes up.
double InkField::left_of_edge(const Vector2d& from, const Vector2d& to) const {
  const Axis across{grid_.columns}, up{grid_.rows};
  if (const int i = across.strip(from.x()), j = up.strip(from.y());
      i >= 0 && i <= across.cells && j >= 0 && j <= up.cells && i == across.strip(to.x()) &&
      j == up.strip(to.y())) {  // within one cell, like most edges
    double sum = 0;
    for (const double gauss : kGauss) {
      const Vector2d at = from + (0.5 + gauss) * (to - from);
      sum += 0.5 * (to.y() - from.y()) * to_the_left(i, j, at.x(), at.y());
    }
    return sum;
  }
  if (from.y() > to.y()) return -left_of_edge(to, from);
  const double lowest = std::max(from.y(), up.begin()), highest = std::min(to.y(), up.end());
  if (!(lowest < highest)) return 0;
  const double slope = (to.x() - from.x()) / (to.y() - from.y());
  const auto u_at = [&](double v) { return from.x() + slope * (v - from.y()); };
  const int step = slope < 0 ? -1 : 1;

  double sum = 0;
  for (int j = static_cast<int>(lowest); j < highest; ++j) {
    double v = std::max<double>(lowest, j);
    const double row_end = std::min<double>(highest, j + 1);
    const int last = across.strip(u_at(row_end));
    for (int strip = across.strip(u_at(v));; strip += step) {
      double end = row_end;
      if (strip != last) {
        const double u_end = across.end_of(step > 0 ? strip : strip - 1);
        end = std::clamp(from.y() + (u_end - from.x()) / slope, v, row_end);
      }
      const int i = std::clamp(strip, 0, across.cells);
      for (const double gauss : kGauss) {
        const double at_v = v + (end - v) * (0.5 + gauss);
        const double at_u = std::clamp(u_at(at_v), across.end_of(i - 1), across.end_of(i));
        sum += (end - v) / 2 * to_the_left(i, j, at_u, at_v);
      }
      v = end;
      if (strip == last) break;
    }
  }
  return sum;
}

double InkField::mean(const Vector2d& a_mm, const Vector2d& b_mm, const Vector2d& c_mm) const {
  const Vector2d a = in_cells(a_mm), b = in_cells(b_mm), c = in_cells(c_mm);
  const double twice_area = cross(b - a, c - a);
  if (nodes_.empty() || !std::isfinite(twice_area) || std::abs(twice_area) < kFlat_cells2) {
    return at((a_mm + b_mm + c_mm) / 3);
  }
  // Green's theorem: the integral over the region left of the edges that go up, minus that over the
  // region left of the other edges.
  const double integral = left_of_edge(a, b) + left_of_edge(b, c) + left_of_edge(c, a);
  return rounded_in(2 * integral / twice_area);
}

double InkField::total_mm2() const {
  double sum = 0;
  for (int j = 1; j <= grid_.rows; ++j) {
    for (int i = 1; i <= grid_.columns; ++i) {
      sum += nodes_[static_cast<std::size_t>(j) * stride_ + i].t;
    }
  }
  return sum * grid_.cell_mm.prod();
}

}  // namespace hydroprint::ink
