#include "sim/print/free_space.h"

#include <algorithm>
#include <cmath>

#include "sim/base/check.h"

namespace hydroprint::print {
namespace {

using Eigen::Vector2d;

constexpr double kCell_mm = 0.5;
constexpr double kRounding_mm = 1e-9;

/// Returns the x at which a polygon's edges cross the height y, from left to right.
std::vector<double> crossings(const std::vector<Vector2d>& polygon, double y) {
  std::vector<double> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d& b = polygon[(i + 1) % polygon.size()];
    if ((a.y() > y) == (b.y() > y)) continue;
    out.push_back(a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x()));
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

FreeSpace::FreeSpace(const Box& printable)
    : printable_(printable),
      columns_(static_cast<int>(printable.size_mm().x() / kCell_mm + kRounding_mm)),
      rows_(static_cast<int>(printable.size_mm().y() / kCell_mm + kRounding_mm)),
      taken_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

FreeSpace::Cells FreeSpace::cells_under(const Box& box) const {
  const auto clamped = [](double cell, int most) {
    return static_cast<int>(std::clamp(cell, 0.0, static_cast<double>(most)));
  };
  const Vector2d low = (box.low_mm - printable_.low_mm) / kCell_mm;
  const Vector2d high = (box.high_mm - printable_.low_mm) / kCell_mm;
  return {clamped(std::floor(low.x() + kRounding_mm), columns_),
          clamped(std::floor(low.y() + kRounding_mm), rows_),
          clamped(std::ceil(high.x() - kRounding_mm), columns_),
          clamped(std::ceil(high.y() - kRounding_mm), rows_)};
}

void FreeSpace::take(const Cells& cells) {
  for (int y = cells.y0; y < cells.y1; ++y) {
    char* row = &taken_[static_cast<std::size_t>(y) * columns_];
    std::fill(row + cells.x0, row + std::max(cells.x0, cells.x1), char{1});
  }
}

void FreeSpace::take(const Box& box) { take(cells_under(box)); }

void FreeSpace::take(const std::vector<Vector2d>& polygon, double clearance_mm) {
  HP_CHECK(polygon.size() >= 3);
  // Sampling rows at mid-height is sufficient: parts between those heights are near an edge, which
  // is marked as taken below.
  for (int y = 0; y < rows_; ++y) {
    const double at_mm = printable_.low_mm.y() + (y + 0.5) * kCell_mm;
    const auto across = crossings(polygon, at_mm);
    for (std::size_t i = 0; i + 1 < across.size(); i += 2) {
      take(Box{{across[i], at_mm}, {across[i + 1], at_mm + kCell_mm / 4}});
    }
  }
  const Vector2d reach = Vector2d::Constant(clearance_mm + kCell_mm / 2);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d& b = polygon[(i + 1) % polygon.size()];
    const int steps = static_cast<int>((b - a).norm() / (kCell_mm / 2)) + 1;
    for (int k = 0; k <= steps; ++k) {
      const Vector2d point = a + (b - a) * k / steps;
      take(Box{point - reach, point + reach});
    }
  }
}

bool FreeSpace::is_free(const Box& box) const {
  if ((box.low_mm - printable_.low_mm).minCoeff() < 0 ||
      (printable_.high_mm - box.high_mm).minCoeff() < 0) {
    return false;
  }
  const Cells cells = cells_under(box);
  for (int y = cells.y0; y < cells.y1; ++y) {
    const char* row = &taken_[static_cast<std::size_t>(y) * columns_];
    if (std::find(row + cells.x0, row + cells.x1, char{1}) != row + cells.x1) return false;
  }
  return true;
}

/// Returns a table of (columns + 1) x (rows + 1) counts. Entry (x, y) is the number of taken cells
/// left of column x and below row y.
std::vector<int> FreeSpace::taken_sums() const {
  const std::size_t stride = static_cast<std::size_t>(columns_) + 1;
  std::vector<int> sums(stride * (static_cast<std::size_t>(rows_) + 1));
  for (int y = 0; y < rows_; ++y) {
    int in_row = 0;
    for (int x = 0; x < columns_; ++x) {
      in_row += taken_[static_cast<std::size_t>(y) * columns_ + x];
      sums[(y + 1) * stride + x + 1] = sums[y * stride + x + 1] + in_row;
    }
  }
  return sums;
}

std::optional<Box> FreeSpace::find(const Vector2d& size_mm, const Vector2d& near_mm) const {
  const int wide = static_cast<int>(std::ceil(size_mm.x() / kCell_mm - kRounding_mm));
  const int high = static_cast<int>(std::ceil(size_mm.y() / kCell_mm - kRounding_mm));
  const std::vector<int> sums = taken_sums();
  const std::size_t stride = static_cast<std::size_t>(columns_) + 1;
  std::optional<Box> best;
  double least = HUGE_VAL;
  for (int y = 0; y + high <= rows_; ++y) {
    const int* below = &sums[y * stride];
    const int* above = &sums[(y + high) * stride];
    for (int x = 0; x + wide <= columns_; ++x) {
      if (above[x + wide] - above[x] - below[x + wide] + below[x] != 0) continue;
      const Vector2d low = printable_.low_mm + Vector2d(x, y) * kCell_mm;
      const double away = (low + size_mm / 2 - near_mm).squaredNorm();
      if (away >= least) continue;
      least = away;
      best = Box{low, low + size_mm};
    }
  }
  return best;
}

}  // namespace hydroprint::print
