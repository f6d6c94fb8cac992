#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/mesh/surface.h"

namespace hydroprint::image {

/// Per point of a surface: the distance in mm to where the surface is projected along each of three
/// axes; 0 on triangles of that axis, at most `most_mm`.
using AxisDistances = std::vector<Eigen::Vector3f>;

/// Assigns each triangle to the axis with which its normal encloses the smallest angle (the earlier
/// one of equals). The distance to an axis is that in space to the nearest edge at which triangles
/// of the axis meet others, so it is continuous across edges, and does not reach through walls.
/// @param axes  columns: three orthonormal directions of frame O
[[nodiscard]] Result<AxisDistances> axis_distances(const mesh::Surface& surface,
                                                   const Eigen::Matrix3d& axes, double most_mm,
                                                   const Context& context);

}  // namespace hydroprint::image
