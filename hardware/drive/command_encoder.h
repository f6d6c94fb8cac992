#pragma once

#include <vector>

#include "hardware/drive/pdu.h"
#include "hardware/drive/profile.h"
#include "sim/base/result.h"

namespace hydroprint::drive {

/// Encodes a command as requests, in order, with position and speed (above 0) where needed. Returns
/// kOutOfRange, reason LIMIT_EXCEEDED, if the speed is not above 0, exceeds the profile's limit, or
/// does not fit the registers.
[[nodiscard]] Result<std::vector<Request>> requests_for(const DriveProfile& profile, Command which,
                                                        double position_mm, double speed_mm_per_s);

}  // namespace hydroprint::drive
