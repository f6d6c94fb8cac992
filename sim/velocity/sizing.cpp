#include "sim/velocity/sizing.h"

#include <algorithm>
#include <cmath>

namespace hydroprint::velocity {
namespace {

constexpr double kCell_mm = 1.0;

}  // namespace

Sizing::Sizing(const film::Outline& outline,
               const std::vector<std::vector<Eigen::Vector2d>>& waterlines, const Options& options)
    : options_(options), origin_mm_(outline.min_mm) {
  // A large film far from the object needs no finer mesh than a small one.
  options_.most_mm = std::max(options.most_mm, 0.05 * outline.size_mm().minCoeff());
  columns_ = static_cast<int>(std::ceil(outline.size_mm().x() / kCell_mm)) + 1;
  rows_ = static_cast<int>(std::ceil(outline.size_mm().y() / kCell_mm)) + 1;
  distance_mm_.assign(static_cast<std::size_t>(columns_) * rows_, 1e6F);
  const auto cell = [&](int column, int row) -> float& {
    return distance_mm_[static_cast<std::size_t>(row) * columns_ + column];
  };
  for (const auto& waterline : waterlines) {
    for (const Eigen::Vector2d& p : waterline) {
      const Eigen::Vector2d at = (p - origin_mm_) / kCell_mm;
      cell(std::clamp(static_cast<int>(std::lround(at.x())), 0, columns_ - 1),
           std::clamp(static_cast<int>(std::lround(at.y())), 0, rows_ - 1)) = 0;
    }
  }
  // Two-pass chamfer: each cell from the neighbours already visited.
  const auto relax = [&](float& here, int column, int row, double step) {
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return;
    here = std::min(here, cell(column, row) + static_cast<float>(step * kCell_mm));
  };
  const double diagonal = std::sqrt(2.0);
  for (int r = 0; r < rows_; ++r) {
    for (int c = 0; c < columns_; ++c) {
      float& here = cell(c, r);
      relax(here, c - 1, r, 1);
      relax(here, c - 1, r - 1, diagonal);
      relax(here, c, r - 1, 1);
      relax(here, c + 1, r - 1, diagonal);
    }
  }
  for (int r = rows_ - 1; r >= 0; --r) {
    for (int c = columns_ - 1; c >= 0; --c) {
      float& here = cell(c, r);
      relax(here, c + 1, r, 1);
      relax(here, c + 1, r + 1, diagonal);
      relax(here, c, r + 1, 1);
      relax(here, c - 1, r + 1, diagonal);
    }
  }
}

double Sizing::at(const Eigen::Vector2d& point_mm) const {
  const Eigen::Vector2d at = (point_mm - origin_mm_) / kCell_mm;
  const int column = std::clamp(static_cast<int>(std::lround(at.x())), 0, columns_ - 1);
  const int row = std::clamp(static_cast<int>(std::lround(at.y())), 0, rows_ - 1);
  const double distance = distance_mm_[static_cast<std::size_t>(row) * columns_ + column];
  return std::min(options_.most_mm, options_.at_waterline_mm + options_.growth * distance);
}

}  // namespace hydroprint::velocity
