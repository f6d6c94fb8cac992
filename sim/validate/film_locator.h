#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "sim/flow/surface_map.h"
#include "sim/mesh/surface.h"

namespace hydroprint::validate {

/// Where points of the film land: the flow map the other way round.
class FilmLocator {
 public:
  /// Both must outlive the locator.
  FilmLocator(const mesh::Surface& surface, const std::vector<flow::MappedTriangle>& tiles);

  /// The point of the surface, in O, mm. Film that has landed stays: of several places the earliest
  /// contact counts. Between tiles, the nearest within 0.1 mm on the film; none: it lands nowhere.
  [[nodiscard]] std::optional<Eigen::Vector3d> at(const Eigen::Vector2d& film_mm) const;

 private:
  struct Cell {
    int column = 0, row = 0;
  };
  [[nodiscard]] Cell cell(const Eigen::Vector2d& film_mm) const;

  const mesh::Surface& surface_;
  const std::vector<flow::MappedTriangle>& tiles_;
  Eigen::Vector2d low_mm_ = Eigen::Vector2d::Zero();
  int columns_ = 0, rows_ = 0;
  std::vector<int> start_;  ///< per cell: its first in tiles_of_
  std::vector<int> tiles_of_;
};

}  // namespace hydroprint::validate
