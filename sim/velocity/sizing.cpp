#include "sim/velocity/sizing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hydroprint::velocity {
namespace {

constexpr double kCell_mm = 1.0;
constexpr float kStep_mm = kCell_mm;
constexpr float kDiagonal_mm = std::numbers::sqrt2_v<float> * kStep_mm;
constexpr float kFar_mm = 1e6F;

/// Half a pass of the chamfer transform: updates a row from the adjacent one.
void relax_from_row(const float* beside, float* here, int columns) {
  for (int c = 0; c < columns; ++c) {
    const float diagonal = std::min(beside[c - 1], beside[c + 1]) + kDiagonal_mm;
    here[c] = std::min({here[c], beside[c] + kStep_mm, diagonal});
  }
}

}  // namespace

Sizing::Sizing(const film::Outline& outline,
               const std::vector<std::vector<Eigen::Vector2d>>& waterlines, const Options& options)
    : options_(options), origin_mm_(outline.min_mm) {
  // On a large film, triangles far from the object may be larger than on a small one.
  options_.most_mm = std::max(options.most_mm, 0.05 * outline.size_mm().minCoeff());
  columns_ = static_cast<int>(std::ceil(outline.size_mm().x() / kCell_mm)) + 1;
  rows_ = static_cast<int>(std::ceil(outline.size_mm().y() / kCell_mm)) + 1;
  distance_mm_.assign(static_cast<std::size_t>(columns_ + 2) * (rows_ + 2), kFar_mm);
  for (const auto& waterline : waterlines) {
    for (const Eigen::Vector2d& p : waterline) distance_mm_[cell_at(p)] = 0;
  }
  const auto row = [&](int r) {
    return distance_mm_.data() + static_cast<std::size_t>(r + 1) * (columns_ + 2) + 1;
  };
  for (int r = 0; r < rows_; ++r) {
    relax_from_row(row(r - 1), row(r), columns_);
    float* const here = row(r);
    for (int c = 0; c < columns_; ++c) here[c] = std::min(here[c], here[c - 1] + kStep_mm);
  }
  for (int r = rows_ - 1; r >= 0; --r) {
    relax_from_row(row(r + 1), row(r), columns_);
    float* const here = row(r);
    for (int c = columns_ - 1; c >= 0; --c) here[c] = std::min(here[c], here[c + 1] + kStep_mm);
  }
}

std::size_t Sizing::cell_at(const Eigen::Vector2d& point_mm) const {
  const Eigen::Vector2d at = (point_mm - origin_mm_) / kCell_mm;
  const int column = std::clamp(static_cast<int>(std::lround(at.x())), 0, columns_ - 1);
  const int row = std::clamp(static_cast<int>(std::lround(at.y())), 0, rows_ - 1);
  return static_cast<std::size_t>(row + 1) * (columns_ + 2) + column + 1;
}

double Sizing::at(const Eigen::Vector2d& point_mm) const {
  const double distance = distance_mm_[cell_at(point_mm)];
  return std::min(options_.most_mm, options_.at_waterline_mm + options_.growth * distance);
}

}  // namespace hydroprint::velocity
