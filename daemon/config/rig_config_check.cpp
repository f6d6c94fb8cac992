#include "daemon/config/rig_config_check.h"

#include <fmt/format.h>

#include <utility>

namespace hydroprint::daemon {

Result<std::optional<ControllerConfig>> read_controller_config(const Config& config) {
  if (config.rig_drive.empty()) return std::optional<ControllerConfig>();
  ControllerConfig setup;
  setup.config = config.rig;
  auto endpoint = drive::parse_endpoint(config.rig_drive);
  if (!endpoint) {
    Error error = std::move(endpoint).error();
    error.message.insert(0, "rig.drive: ");
    return tl::unexpected(std::move(error));
  }
  setup.endpoint = std::move(*endpoint);
  if (config.rig_profile.empty()) {
    return fail(Code::kInvalidArgument,
                fmt::format("rig.profile is empty; name the profile of the drive at {}, a file "
                            "like hardware/profiles/virtual.toml",
                            config.rig_drive),
                ErrorReason::CONFIG_INVALID);
  }
  HP_ASSIGN_OR_RETURN(setup.profile, drive::read_drive_profile(config.rig_profile));
  HP_RETURN_IF_ERROR(rig::check(setup.config, setup.profile));
  return std::optional(std::move(setup));
}

}  // namespace hydroprint::daemon
