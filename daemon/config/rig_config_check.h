#pragma once

#include <optional>

#include "daemon/config/config.h"
#include "hardware/drive/profile.h"
#include "hardware/drive/transaction.h"

namespace hydroprint::daemon {

/// The arguments of a rig::Controller.
struct ControllerConfig {
  rig::RigConfig config;
  drive::DriveProfile profile;
  drive::Endpoint endpoint;
};

/// Reads the drive's profile and checks that the rig can be driven safely with this configuration;
/// nullopt if no rig is configured.
/// @return kInvalidArgument, CONFIG_INVALID, one line that names the key, or the profile's line
[[nodiscard]] Result<std::optional<ControllerConfig>> read_controller_config(const Config& config);

}  // namespace hydroprint::daemon
