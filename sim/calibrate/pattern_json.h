#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "sim/scan/fixed_pattern.h"

namespace hydroprint::calibrate {

/// Converts a fixed pattern to JSON: the side of its squares in pixels, and their offsets, sigmas
/// and shared errors. Each list is the base64 encoding of its bytes (32-bit floats, little endian;
/// 8-bit multiples of a step, column by column). Include this header in .cpp files only.
[[nodiscard]] nlohmann::ordered_json pattern_json(const scan::FixedPattern& pattern);

/// Reads the pattern of an image of this size; nullopt if it is incomplete or out of range. Uses no
/// more memory than the text. Throws nlohmann::json exceptions if a part is missing.
[[nodiscard]] std::optional<scan::FixedPattern> pattern_of(const nlohmann::json& json, int width_px,
                                                           int height_px);

}  // namespace hydroprint::calibrate
