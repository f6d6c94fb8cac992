#pragma once

#include <span>
#include <vector>

#include "sim/flow/surface_map.h"
#include "sim/image/film/film_image.h"

namespace hydroprint::image {

/// Lists the tiles that may touch each square block of a grid, in tile order.
class TileBins {
 public:
  TileBins(const std::vector<flow::MappedTriangle>& tiles, const FilmGrid& grid, int block);

  [[nodiscard]] std::size_t count() const { return start_.size() - 1; }
  [[nodiscard]] std::span<const int> tiles(std::size_t block) const {
    return {tiles_.data() + start_[block], tiles_.data() + start_[block + 1]};
  }
  [[nodiscard]] Window window(std::size_t block) const;

 private:
  FilmGrid grid_;
  int block_;
  int blocks_across_, blocks_down_;
  std::vector<std::size_t> start_;
  std::vector<int> tiles_;
};

}  // namespace hydroprint::image
