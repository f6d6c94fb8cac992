#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/base/context.h"
#include "sim/mesh/patches.h"
#include "sim/mesh/shell.h"

namespace hydroprint::mesh {

/// Whether a patch faces inward, and the rule that decided.
struct Side {
  SideRule rule = SideRule::kVolume;
  bool turn_over = false;
};

/// Decides for each patch which side is outside, by the rules of orient().
[[nodiscard]] Result<std::vector<Side>> outer_sides(const std::vector<Eigen::Vector3d>& points,
                                                    const std::vector<Eigen::Vector3i>& triangles,
                                                    const Patches& found, const Context& context);

}  // namespace hydroprint::mesh
