#pragma once

#include "sim/mesh/model.h"

namespace hydroprint::mesh {

/// What is odd about a model's texture coordinates, if it has any: `uv_overlapping` when more than
/// 0.5 % of the texture that is used is used twice (judged on 1024 x 1024 points, per material),
/// `uv_mirrored` when more than 0.5 % of the area in the texture shows its picture mirrored. Both
/// are often meant; nothing is refused.
[[nodiscard]] Warnings uv_warnings(const Model& model);

}  // namespace hydroprint::mesh
