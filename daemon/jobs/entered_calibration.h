#pragma once

#include "hydroprint/v1/calibration_service.pb.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

/// Checks a manually entered calibration, beyond the rules of its fields (check_fields()).
/// @return a calibration with only the fields that the client sets; SPEC_INVALID, NAME_INVALID,
///         ID_INVALID
[[nodiscard]] Result<v1::Calibration> check_calibration(const v1::Calibration& entered);

}  // namespace hydroprint::daemon
