#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::loop {

/// What surface_map.ply holds, as far as it is needed here: the object's points (O), where on the
/// film each comes from (NaN: nowhere) and when, and the triangles between them.
struct SurfaceMap {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector2d> film_mm;
  std::vector<double> time_s;
  std::vector<Eigen::Vector3i> triangles;
};

/// Refuses a file that is not such a one (kInvalidArgument).
[[nodiscard]] Result<SurfaceMap> read_surface_map(const std::filesystem::path& path);

/// Where on the object a point of the film lands: on the triangle that takes it first, evenly
/// between its corners.
class FilmLocator {
 public:
  /// @param map  outlives it
  explicit FilmLocator(const SurfaceMap& map);

  /// None: nowhere.
  [[nodiscard]] std::optional<Eigen::Vector3d> at(const Eigen::Vector2d& film_mm) const;

 private:
  [[nodiscard]] int column(double x_mm) const;
  [[nodiscard]] int row(double y_mm) const;

  const SurfaceMap& map_;
  std::vector<std::vector<int>> cells_;
};

}  // namespace hydroprint::loop
