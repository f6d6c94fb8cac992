#pragma once

#include <vector>

#include "sim/base/result.h"
#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// Points p with normal . p = offset; camera frame, the normal towards the camera.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset_mm = 0;

  [[nodiscard]] double height_mm(const Eigen::Vector3d& p) const {
    return normal.dot(p) - offset_mm;
  }
};

/// The plane that most points lie on: table or water, which tells up. Random sampling (Fischler and
/// Bolles 1981) with a fixed seed, then least squares.
/// @param up_C  about where up is; planes tilted to it by more than 40 degrees do not count
/// Refuses (kFailedPrecondition, NO_PLANE) where fewer than a twentieth of the points lie on it.
[[nodiscard]] Result<Plane> find_plane(const scan::Cloud& cloud, const Eigen::Vector3d& up_C);

/// Heights over the plane at which there is much that is level (table, water, bars); most first, at
/// most six.
[[nodiscard]] std::vector<double> level_heights(const scan::Cloud& cloud, const Plane& plane);

}  // namespace hydroprint::registration
