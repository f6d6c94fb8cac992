#pragma once

#include <optional>

#include "daemon/config.h"
#include "hardware/drive/link.h"
#include "hardware/drive/profile.h"

namespace hydroprint::daemon {

/// What a rig::Controller is made of.
struct RigSetup {
  rig::RigConfig config;
  drive::DriveProfile profile;
  drive::Endpoint endpoint;
};

/// Reads the drive's profile and checks that the rig can be driven safely as it is configured; none
/// if no rig is.
/// @return kInvalidArgument, CONFIG_INVALID, one line that names the key, or the profile's line
[[nodiscard]] Result<std::optional<RigSetup>> read_rig_setup(const Config& config);

}  // namespace hydroprint::daemon
