#include "sim/validate/film_locator.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "sim/image/film/stretch.h"
#include "sim/image/texture/raster.h"

namespace hydroprint::validate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kCell_mm = 1;
constexpr double kGap_mm = 0.1;

bool is_finite(const flow::MappedTriangle& tile) {
  return tile.film_mm[0].allFinite() && tile.film_mm[1].allFinite() && tile.film_mm[2].allFinite();
}

Vector3d nearest_on_segment(const Vector2d& p, const Vector2d& a, const Vector2d& b, int i, int j) {
  const Vector2d along = b - a;
  const double square = along.squaredNorm();
  const double t = square > 0 ? std::clamp((p - a).dot(along) / square, 0.0, 1.0) : 0;
  Vector3d weights = Vector3d::Zero();
  weights[i] = 1 - t;
  weights[j] = t;
  return weights;
}

/// Returns the barycentric coordinates of the tile's point nearest to p on the film.
Vector3d nearest(const flow::MappedTriangle& tile, const Vector2d& p) {
  const Vector3d inside = image::BarycentricMap(tile.film_mm).at(p.x(), p.y());
  if (inside.minCoeff() >= 0) return inside;
  Vector3d best = Vector3d::UnitX();
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const Vector3d b = nearest_on_segment(p, tile.film_mm[i], tile.film_mm[j], i, j);
    const double d = (b[i] * tile.film_mm[i] + b[j] * tile.film_mm[j] - p).norm();
    if (d < least) {
      least = d;
      best = b;
    }
  }
  return best;
}

}  // namespace

FilmLocator::FilmLocator(const mesh::Surface& surface,
                         const std::vector<flow::MappedTriangle>& tiles)
    : surface_(surface), tiles_(tiles) {
  Eigen::AlignedBox2d box;
  for (const auto& tile : tiles) {
    if (!is_finite(tile)) continue;
    for (const Vector2d& p : tile.film_mm) box.extend(p);
  }
  if (box.isEmpty()) return;
  low_mm_ = box.min() - Vector2d::Constant(kGap_mm);
  const Vector2d size = box.max() - low_mm_;
  columns_ = static_cast<int>(size.x() / kCell_mm) + 1;
  rows_ = static_cast<int>(size.y() / kCell_mm) + 1;
  start_.assign(static_cast<std::size_t>(columns_) * rows_ + 1, 0);
  const auto for_each_cell = [&](const flow::MappedTriangle& tile, auto&& visit) {
    if (!is_finite(tile)) return;
    const auto& [a, b, c] = tile.film_mm;
    const Vector2d gap = Vector2d::Constant(kGap_mm);
    const Cell first = cell(a.cwiseMin(b).cwiseMin(c) - gap);
    const Cell last = cell(a.cwiseMax(b).cwiseMax(c) + gap);
    for (int row = first.row; row <= last.row; ++row) {
      for (int column = first.column; column <= last.column; ++column) {
        visit(static_cast<std::size_t>(row) * columns_ + column);
      }
    }
  };
  for (const auto& tile : tiles) {
    for_each_cell(tile, [&](std::size_t i) { ++start_[i + 1]; });
  }
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  tiles_of_.resize(start_.back());
  std::vector<int> next(start_.begin(), start_.end() - 1);
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    for_each_cell(tiles[t], [&](std::size_t i) { tiles_of_[next[i]++] = static_cast<int>(t); });
  }
}

FilmLocator::Cell FilmLocator::cell(const Vector2d& film_mm) const {
  const Vector2d at = (film_mm - low_mm_) / kCell_mm;
  return {static_cast<int>(std::clamp(at.x(), 0.0, columns_ - 1.0)),
          static_cast<int>(std::clamp(at.y(), 0.0, rows_ - 1.0))};
}

std::optional<Vector3d> FilmLocator::at(const Vector2d& film_mm) const {
  if (!film_mm.allFinite() || columns_ == 0) return std::nullopt;
  const Cell here = cell(film_mm);
  const std::size_t index = static_cast<std::size_t>(here.row) * columns_ + here.column;
  double least_mm = kGap_mm, earliest_s = std::numeric_limits<double>::infinity();
  const flow::MappedTriangle* best = nullptr;
  Vector3d weights = Vector3d::Zero();
  for (int k = start_[index]; k < start_[index + 1]; ++k) {
    const flow::MappedTriangle& tile = tiles_[tiles_of_[k]];
    const auto& f = tile.film_mm;
    const Vector3d b = nearest(tile, film_mm);
    const double distance_mm = (b[0] * f[0] + b[1] * f[1] + b[2] * f[2] - film_mm).norm();
    const double time_s = b[0] * static_cast<double>(tile.contact_time_s[0]) +
                          b[1] * static_cast<double>(tile.contact_time_s[1]) +
                          b[2] * static_cast<double>(tile.contact_time_s[2]);
    // Prefers the earliest of the tiles that contain the point, otherwise the nearest tile.
    constexpr double kRounding_mm = 1e-9;
    const bool is_better = distance_mm < kRounding_mm
                               ? least_mm >= kRounding_mm || time_s < earliest_s
                               : distance_mm < least_mm && least_mm >= kRounding_mm;
    if (!is_better) continue;
    least_mm = distance_mm;
    earliest_s = time_s;
    best = &tile;
    weights = b;
  }
  if (best == nullptr) return std::nullopt;
  const auto points = image::tile_points(surface_, *best);
  return Vector3d(weights[0] * points[0] + weights[1] * points[1] + weights[2] * points[2]);
}

}  // namespace hydroprint::validate
