#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/film/outline.h"

namespace hydroprint::velocity {

/// Target edge length at each point of the film: small at the waterline, and growing with the
/// distance from it. The distance is a chamfer transform on a grid, whose error of a few percent is
/// small enough for mesh sizes.
class Sizing {
 public:
  struct Options {
    double at_waterline_mm = 3.75;
    double growth = 1.05;  ///< mm of edge length per mm of distance
    double most_mm = 37.5;
  };

  Sizing(const film::Outline& outline, const std::vector<std::vector<Eigen::Vector2d>>& waterlines,
         const Options& options);

  [[nodiscard]] double at(const Eigen::Vector2d& point_mm) const;

 private:
  [[nodiscard]] std::size_t cell_at(const Eigen::Vector2d& point_mm) const;

  Options options_;
  Eigen::Vector2d origin_mm_;
  int columns_ = 0, rows_ = 0;
  /// Distances for the cells and a margin of one cell around them.
  std::vector<float> distance_mm_;
};

}  // namespace hydroprint::velocity
