#pragma once

#include <filesystem>
#include <string>

#include "sim/base/result.h"
#include "sim/registration/camera/calibrate_camera.h"

namespace hydroprint::calibrate {

/// A camera's calibration as JSON: image size, each parameter of the lens by name (Lens), their
/// covariance in that order, how well the board fitted, and the fixed pattern, if it is known
/// (pattern_json.h). Reads back as the very same values.
[[nodiscard]] std::string camera_json(const registration::CameraCalibration& camera);

/// The same without the fixed pattern, for people.
[[nodiscard]] std::string camera_summary_json(const registration::CameraCalibration& camera);

/// Reads one; one without a pattern is one whose pattern is not known. Refuses what read_json_file
/// refuses, and what is not complete or out of range, or whose pattern is not of the image's size
/// (kInvalidArgument).
[[nodiscard]] Result<registration::CameraCalibration> read_camera(
    const std::filesystem::path& path);

}  // namespace hydroprint::calibrate
