#pragma once

#include <Eigen/Geometry>

namespace hydroprint {

/// Rigid transform, rotation and translation in mm. `X_FO` takes coordinates of the object frame O
/// to the film frame F (contract, "Frames and units").
using Pose = Eigen::Isometry3d;

}  // namespace hydroprint
