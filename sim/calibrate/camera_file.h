#pragma once

#include <filesystem>
#include <string>

#include "sim/base/result.h"
#include "sim/registration/camera/calibrate_camera.h"

namespace hydroprint::calibrate {

/// A camera's calibration as JSON: image size, each lens parameter by name (Lens), their covariance
/// in that order, the fit to the board, and the fixed pattern if known (pattern_json.h). Reading it
/// back gives exactly the same values.
[[nodiscard]] std::string camera_json(const registration::CameraCalibration& camera);

/// Same as camera_json(), for people: without the fixed pattern.
[[nodiscard]] std::string camera_summary_json(const registration::CameraCalibration& camera);

/// Reads a camera's calibration; the fixed pattern may be missing. Fails as read_json_file() does,
/// and with kInvalidArgument if a value is missing or out of range, or if the pattern does not
/// match the image size.
[[nodiscard]] Result<registration::CameraCalibration> read_camera(
    const std::filesystem::path& path);

}  // namespace hydroprint::calibrate
