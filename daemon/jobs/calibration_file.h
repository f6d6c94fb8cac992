#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint::v1 {
class Calibration;
}

namespace hydroprint::daemon {

// Readers for files written by a worker, which are untrusted. They return kInternal,
// WORKER_UNUSABLE if a key is missing or out of range.

/// Reads calibration.json into the fields of a calibration.
[[nodiscard]] Status read_calibration(const std::string& json, v1::Calibration& out);

/// Same as read_calibration(), for camera.json.
[[nodiscard]] Status read_camera(const std::string& json, v1::Calibration& out);

}  // namespace hydroprint::daemon
