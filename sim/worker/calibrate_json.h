#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "sim/calibrate/calibrate.h"
#include "sim/registration/calibrate_camera.h"

// For inclusion in .cpp files only.
namespace hydroprint::worker {

/// As pose files have it (contract, `--pose`).
[[nodiscard]] nlohmann::ordered_json pose_json(const Pose& X_FO);

/// Where the camera was, how well the markers fit together, and what became of each.
[[nodiscard]] nlohmann::ordered_json film_frame_json(const registration::FilmFrame& frame);

/// calibration.json: pose, covariance, what is not known, film frame and markers, water, scan.
/// @param lowest_mm  z of the object's lowest point (F), for its height over the water
[[nodiscard]] nlohmann::ordered_json calibration_json(const calibrate::Calibration& calibration,
                                                      double lowest_mm);

/// A line or two for people.
[[nodiscard]] std::string calibration_text(const calibrate::Calibration& calibration,
                                           const std::filesystem::path& dir);
[[nodiscard]] std::string camera_text(const registration::CameraCalibration& camera,
                                      const std::filesystem::path& dir);

}  // namespace hydroprint::worker
