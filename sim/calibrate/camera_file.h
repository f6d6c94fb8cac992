#pragma once

#include <filesystem>
#include <string>

#include "sim/base/result.h"
#include "sim/registration/camera/calibrate_camera.h"

namespace hydroprint::calibrate {

/// Converts a camera calibration to JSON: image size, each lens parameter by name (Lens), their
/// covariance in the same order, the fit to the board, and the fixed pattern if known
/// (pattern_json.h). read_camera() restores exactly the same values.
[[nodiscard]] std::string camera_json(const registration::CameraCalibration& camera);

/// Reads a camera calibration; the fixed pattern may be missing. Returns the errors of
/// read_json_file(), and kInvalidArgument if a value is missing or out of range, or if the pattern
/// does not match the image size.
[[nodiscard]] Result<registration::CameraCalibration> read_camera(
    const std::filesystem::path& path);

}  // namespace hydroprint::calibrate
