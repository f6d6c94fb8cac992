#pragma once

#include <Eigen/Geometry>

namespace hydroprint {

/// A rigid transform: rotation and translation in mm. `X_FO` transforms coordinates in the object
/// frame O to the film frame F.
using Pose = Eigen::Isometry3d;

}  // namespace hydroprint
