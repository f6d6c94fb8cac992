#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "sim/flow/surface_map.h"
#include "sim/mesh/surface.h"

namespace hydroprint::validate {

/// Finds where points of the film land, by inverting the flow map.
class FilmLocator {
 public:
  /// @param surface, tiles  must outlive the locator
  FilmLocator(const mesh::Surface& surface, const std::vector<flow::MappedTriangle>& tiles);

  /// Returns the point of the surface where a film point lands, in the object frame O, mm; nullopt
  /// if it does not land. If several points qualify, returns the one with the earliest contact,
  /// because film that has landed does not move. Between tiles, uses the nearest tile within 0.1 mm
  /// on the film.
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
  std::vector<int> start_;  ///< for each cell, the index of its first entry in tiles_of_
  std::vector<int> tiles_of_;
};

}  // namespace hydroprint::validate
