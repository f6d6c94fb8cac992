#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "daemon/config/config.h"

namespace hydroprint::daemon {

/// The depth camera over the vat, as it is configured.
struct CameraConfig {
  std::string device;             ///< OpenNI2's name of it; "any": the first there is; empty: none
  std::filesystem::path program;  ///< hydroprint-capture
  int patience_s = 5;             ///< with a camera that does not answer
  std::filesystem::path layout;   ///< of markers and camera, TOML; empty: none
  /// Axis position at which the gripper's lower end is level with the water, if it is known.
  std::optional<double> gripper_water_mm;
};

/// The camera and what it looks at.
/// @return kInvalidArgument, CONFIG_INVALID, one line that names the key
[[nodiscard]] Result<CameraConfig> read_camera_setup(const Config& config);

/// kFailedPrecondition, CAMERA_MISSING if none is configured.
[[nodiscard]] Status check_camera(const CameraConfig& setup);

/// The layout's text. CONFIG_INVALID if the file cannot be read.
[[nodiscard]] Result<std::string> read_layout_text(const CameraConfig& setup);

}  // namespace hydroprint::daemon
