#pragma once

#include "sim/mesh/model.h"

namespace hydroprint::mesh {

/// Returns warnings about unusual texture coordinates. `UV_OVERLAPPING`: more than 0.5 % of the
/// used texture is used twice (measured at 1024 x 1024 points, per material). `UV_MIRRORED`: more
/// than 0.5 % of the area in the texture appears mirrored on the object. Overlapping and mirrored
/// coordinates are often intended, so they are not errors.
[[nodiscard]] Warnings uv_warnings(const Model& model);

}  // namespace hydroprint::mesh
