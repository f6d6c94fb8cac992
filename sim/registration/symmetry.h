#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/registration/shape.h"

namespace hydroprint::registration {

/// Finds the axes through the centroid about which every turn carries the surface onto itself:
/// none, one (a cylinder, a bottle) or three perpendicular ones (a sphere). No scan determines
/// these turns. Turned surfaces may differ by 0.5 % of the largest distance from the axis, because
/// meshes consist of facets. So relief finer than that is overlooked, and so is a part with less
/// than about 0.02 % of the area. Unit vectors, frame B. Source: the slippable motions of a surface
/// (Gelfand and Guibas, Shape segmentation using local slippage analysis, SGP 2004), restricted to
/// turns and confirmed by turning the surface.
[[nodiscard]] std::vector<Eigen::Vector3d> symmetry_axes(const Shape& shape);

}  // namespace hydroprint::registration
