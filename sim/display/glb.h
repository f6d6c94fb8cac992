#pragma once

#include <string>

#include "sim/base/result.h"
#include "sim/display/display_model.h"

namespace hydroprint::display {

/// Writes a model as binary glTF 2.0 for display: one mesh with a primitive for each part, and
/// materials that need no light (KHR_materials_unlit). All primitives share the same accessors for
/// positions (mm), places (_PLACE, as floats), texture coordinates and colours. A node translates
/// by the model's origin.
/// @param extras  JSON for the extras of the asset; empty: none
/// @return kInternal if `extras` is not JSON, or for more than 4 GiB
[[nodiscard]] Result<std::string> glb_of(const DisplayModel& model, const std::string& extras);

}  // namespace hydroprint::display
