#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "sim/scan/fixed_pattern.h"

namespace hydroprint::calibrate {

/// A fixed pattern as JSON: the side of its squares in pixels, and their offsets, sigmas and what
/// they share, each as bytes in base64 (32-bit floats, little endian; whole steps of 8 bits, column
/// after column). For inclusion in .cpp files only.
[[nodiscard]] nlohmann::ordered_json pattern_json(const scan::FixedPattern& pattern);

/// Reads one of an image's size; nothing if it is not complete, or out of range. Takes no more
/// memory than the text has. Throws what nlohmann::json does where a part is missing.
[[nodiscard]] std::optional<scan::FixedPattern> pattern_of(const nlohmann::json& json, int width_px,
                                                           int height_px);

}  // namespace hydroprint::calibrate
