#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/pose.h"
#include "sim/mesh/surface.h"
#include "sim/plan/blend.h"
#include "sim/plan/regions.h"

namespace hydroprint::pipeline {

/// A surface divided among dips (section 6).
struct Division {
  plan::Regions regions;
  plan::BlendWeights weights;
};

/// Returns the earlier dip that lowers the object in the same orientation as dip k (from 0), apart
/// from a turn about the vertical; nullopt if there is none.
/// @param X_FO  pose of each dip
[[nodiscard]] std::optional<std::size_t> repeated_by(const std::vector<Pose>& X_FO, std::size_t k);

/// Returns the stretch by which a surface is divided. A repeated dip gets only what the earlier one
/// does not reach; otherwise rounding would decide.
/// @param stretch  per dip and point of the surface; NaN where no film arrives
[[nodiscard]] plan::Stretch dividing_stretch(const std::vector<Pose>& X_FO, plan::Stretch stretch);

/// Divides a surface by least stretch, and computes how the dips blend. Errors: those of
/// plan::make_regions() and plan::BlendWeights::create().
[[nodiscard]] Result<Division> divide(const mesh::Surface& surface, const plan::Stretch& stretch,
                                      double blend_mm, const Context& context);

}  // namespace hydroprint::pipeline
