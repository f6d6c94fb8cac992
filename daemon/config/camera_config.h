#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "daemon/config/config.h"

namespace hydroprint::daemon {

/// Configuration of the depth camera above the vat.
struct CameraConfig {
  /// Name of the camera in OpenNI2; "any": the first one found; empty: no camera.
  std::string device;
  std::filesystem::path program;  ///< hydroprint-capture
  int patience_s = 5;             ///< timeout for a camera that does not respond
  std::filesystem::path
      layout;  ///< TOML file that describes the markers and the camera; empty: none
  /// Axis position at which the gripper's lower end is level with the water, if known.
  std::optional<double> gripper_water_mm;
};

/// Reads the camera's configuration.
/// @return kInvalidArgument, CONFIG_INVALID, one line that names the key
[[nodiscard]] Result<CameraConfig> read_camera_setup(const Config& config);

/// Returns kFailedPrecondition, CAMERA_MISSING if no camera is configured.
[[nodiscard]] Status check_camera(const CameraConfig& setup);

/// Reads the layout file. Errors: CONFIG_INVALID.
[[nodiscard]] Result<std::string> read_layout_text(const CameraConfig& setup);

}  // namespace hydroprint::daemon
