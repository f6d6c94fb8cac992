#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::fit {

/// A printed point and its measured position on the object.
struct Point {
  Eigen::Vector2d film_mm = Eigen::Vector2d::Zero();     ///< position in the printed image, in F
  Eigen::Vector3d surface_mm = Eigen::Vector3d::Zero();  ///< measured position, in O
};

inline constexpr std::size_t kMostPoints = 20'000;

/// Reads a file with the header `film_x_mm,film_y_mm,X_mm,Y_mm,Z_mm` and 1 to 20,000 rows. Returns
/// the errors of read_csv(), and an error for coordinates beyond 1e4 mm or a file without rows.
/// Errors name file, line and remedy.
[[nodiscard]] Result<std::vector<Point>> read_points(const std::filesystem::path& path);

}  // namespace hydroprint::fit
