#pragma once

#include <cstdint>
#include <vector>

#include "hardware/drive/drive.h"

namespace hydroprint::drive {

/// Returns whether a block contains the whole field.
[[nodiscard]] bool holds(const Block& block, const Field& field);

/// Decodes the polled blocks, in the order of the profile. Does not set DriveState::time and
/// time_error, nor the velocity if the profile has none.
[[nodiscard]] DriveState decode_state(const DriveProfile& profile,
                                      const std::vector<std::vector<std::uint16_t>>& blocks);

}  // namespace hydroprint::drive
