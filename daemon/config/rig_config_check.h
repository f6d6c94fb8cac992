#pragma once

#include <optional>

#include "daemon/config/config.h"
#include "hardware/drive/profile.h"
#include "hardware/drive/transaction.h"

namespace hydroprint::daemon {

/// What a rig::Controller is made of.
struct ControllerConfig {
  rig::RigConfig config;
  drive::DriveProfile profile;
  drive::Endpoint endpoint;
};

/// Reads the drive's profile and checks that the rig can be driven safely as it is configured; none
/// if no rig is.
/// @return kInvalidArgument, CONFIG_INVALID, one line that names the key, or the profile's line
[[nodiscard]] Result<std::optional<ControllerConfig>> read_controller_config(const Config& config);

}  // namespace hydroprint::daemon
