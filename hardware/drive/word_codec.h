#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hardware/drive/profile.h"
#include "sim/base/result.h"

namespace hydroprint::drive {

/// The words of a value in mm, mm/s, mm/s^2 or s. Refuses with kOutOfRange, reason LIMIT_EXCEEDED,
/// what they cannot hold; and what is not 0 but would be rounded to it.
[[nodiscard]] Result<std::vector<std::uint16_t>> encode(const Format& format, double value);

/// The value of `format.words` words; of an inverse one with raw 0: infinity.
[[nodiscard]] double decode(const Format& format, std::span<const std::uint16_t> words);

/// How many words `quantity` takes in this profile's writes.
[[nodiscard]] int words_of(const DriveProfile& profile, Quantity quantity);

}  // namespace hydroprint::drive
