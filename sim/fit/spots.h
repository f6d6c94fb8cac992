#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/mesh/surface.h"

namespace hydroprint::fit {

/// A point of a surface.
struct Spot {
  int triangle = 0;
  /// Weights of the triangle's corners 0, 1, 2.
  Eigen::Vector3d barycentric = Eigen::Vector3d::UnitX();
  double distance_mm = 0;  ///< distance from the requested point
};

/// Returns the nearest point of the surface for each point (O, mm). If several triangles share the
/// nearest point, the first of them is returned.
[[nodiscard]] Result<std::vector<Spot>> nearest_spots(const mesh::Surface& surface,
                                                      const std::vector<Eigen::Vector3d>& points_mm,
                                                      const Context& context);

}  // namespace hydroprint::fit
