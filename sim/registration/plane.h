#pragma once

#include <vector>

#include "sim/base/result.h"
#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// The points p with normal . p = offset, in the camera frame. The normal points to the camera.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset_mm = 0;

  [[nodiscard]] double height_mm(const Eigen::Vector3d& p) const {
    return normal.dot(p) - offset_mm;
  }
};

/// Finds the plane that contains the largest number of points (the table or the water), which
/// defines up. Uses random sampling (Fischler and Bolles 1981) with a fixed seed, then least
/// squares. Returns kFailedPrecondition (NO_PLANE) if fewer than a twentieth of the points lie on
/// the plane.
/// @param up_C  approximate up direction; planes tilted from it by more than 40 degrees are ignored
[[nodiscard]] Result<Plane> find_plane(const scan::Cloud& cloud, const Eigen::Vector3d& up_C);

/// Returns the heights above the plane at which the scan has large horizontal areas (table, water,
/// bars): at most six, largest area first.
[[nodiscard]] std::vector<double> level_heights(const scan::Cloud& cloud, const Plane& plane);

}  // namespace hydroprint::registration
