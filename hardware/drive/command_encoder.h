#pragma once

#include <vector>

#include "hardware/drive/pdu.h"
#include "hardware/drive/profile.h"
#include "sim/base/result.h"

namespace hydroprint::drive {

/// The requests of a command, in order; position and speed (above 0) where it takes them.
/// Refuses with kOutOfRange, reason LIMIT_EXCEEDED, a speed that is not above 0 or beyond the
/// profile's, and what the registers cannot hold.
[[nodiscard]] Result<std::vector<Request>> requests_for(const DriveProfile& profile, Command which,
                                                        double position_mm, double speed_mm_per_s);

}  // namespace hydroprint::drive
