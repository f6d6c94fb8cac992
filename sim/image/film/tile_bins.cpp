#include "sim/image/film/tile_bins.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hydroprint::image {
namespace {

/// Returns the first and last block along one axis that the interval [low, high], in cells, may
/// touch.
std::pair<int, int> blocks(double low, double high, int block, int count) {
  const double last = count;
  const int first_block = static_cast<int>(std::clamp(std::floor((low - 1) / block), 0.0, last));
  const int last_block =
      static_cast<int>(std::clamp(std::floor((high + 1) / block), -1.0, last - 1));
  return {first_block, last_block};
}

}  // namespace

TileBins::TileBins(const std::vector<flow::MappedTriangle>& tiles, const FilmGrid& grid, int block)
    : grid_(grid),
      block_(block),
      blocks_across_((grid.columns + block - 1) / block),
      blocks_down_((grid.rows + block - 1) / block),
      start_(static_cast<std::size_t>(blocks_across_) * blocks_down_ + 1, 0) {
  const auto for_each_block = [&](const flow::MappedTriangle& tile, auto&& visit) {
    const Eigen::Vector2d a = grid.cell(tile.film_mm[0]), b = grid.cell(tile.film_mm[1]),
                          c = grid.cell(tile.film_mm[2]);
    if (!a.allFinite() || !b.allFinite() || !c.allFinite()) return;
    const Eigen::Vector2d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
    const auto [x0, x1] = blocks(low.x(), high.x(), block_, blocks_across_);
    const auto [y0, y1] = blocks(low.y(), high.y(), block_, blocks_down_);
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) visit(static_cast<std::size_t>(y) * blocks_across_ + x);
    }
  };
  for (const auto& tile : tiles) {
    for_each_block(tile, [&](std::size_t b) { ++start_[b + 1]; });
  }
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  tiles_.resize(start_.back());
  std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    for_each_block(tiles[t], [&](std::size_t b) { tiles_[next[b]++] = static_cast<int>(t); });
  }
}

Window TileBins::window(std::size_t block) const {
  const int x = static_cast<int>(block % static_cast<std::size_t>(blocks_across_)) * block_;
  const int y = static_cast<int>(block / static_cast<std::size_t>(blocks_across_)) * block_;
  return {x, y, std::min(x + block_, grid_.columns), std::min(y + block_, grid_.rows)};
}

}  // namespace hydroprint::image
