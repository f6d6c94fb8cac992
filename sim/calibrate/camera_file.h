#pragma once

#include <filesystem>
#include <string>

#include "sim/base/result.h"
#include "sim/registration/calibrate_camera.h"

namespace hydroprint::calibrate {

/// A camera's calibration as JSON: image size, each parameter of the lens by name (Lens), their
/// covariance in that order, and how well the board fitted. Reads back as the very same values.
[[nodiscard]] std::string camera_json(const registration::CameraCalibration& camera);

/// Reads one. Refuses what read_json_file refuses, and what is not complete or out of range
/// (kInvalidArgument).
[[nodiscard]] Result<registration::CameraCalibration> read_camera(
    const std::filesystem::path& path);

}  // namespace hydroprint::calibrate
