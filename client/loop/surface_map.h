#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::loop {

/// The parts of surface_map.ply that are needed here: the object's points (O), their film points
/// (NaN: none) and contact times, and the triangles between them.
struct SurfaceMap {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector2d> film_mm;
  std::vector<double> time_s;
  std::vector<Eigen::Vector3i> triangles;
};

/// Reads a surface map; kInvalidArgument if the file is malformed.
[[nodiscard]] Result<SurfaceMap> read_surface_map(const std::filesystem::path& path);

/// Finds where a point of the film lands on the object: in the triangle with the earliest contact,
/// interpolated between its corners.
class FilmLocator {
 public:
  /// @param map  must outlive this object
  explicit FilmLocator(const SurfaceMap& map);

  /// Returns the landing point; nullopt if the film point does not land.
  [[nodiscard]] std::optional<Eigen::Vector3d> at(const Eigen::Vector2d& film_mm) const;

 private:
  [[nodiscard]] int column(double x_mm) const;
  [[nodiscard]] int row(double y_mm) const;

  const SurfaceMap& map_;
  std::vector<std::vector<int>> cells_;
};

}  // namespace hydroprint::loop
