#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hardware/drive/profile.h"
#include "sim/base/result.h"

namespace hydroprint::drive {

/// Encodes a value in mm, mm/s, mm/s^2 or s. Returns kOutOfRange, reason LIMIT_EXCEEDED, if it does
/// not fit, or if a nonzero value would be rounded to 0.
[[nodiscard]] Result<std::vector<std::uint16_t>> encode(const Format& format, double value);

/// Decodes `format.words` words; an inverse format returns infinity for raw 0.
[[nodiscard]] double decode(const Format& format, std::span<const std::uint16_t> words);

/// Returns the number of words of `quantity` in this profile's writes.
[[nodiscard]] int words_of(const DriveProfile& profile, Quantity quantity);

}  // namespace hydroprint::drive
