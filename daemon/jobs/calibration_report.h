#pragma once

#include "sim/base/result.h"

namespace hydroprint::v1 {
class CalibrateCameraReport;
class Calibration;
class CalibrationFacts;
}  // namespace hydroprint::v1

namespace hydroprint::daemon {

/// Copies the result of a worker, which is untrusted, to a calibration.
/// @return kInternal, WORKER_UNUSABLE for values that no calibration has
[[nodiscard]] Status take_calibration(const v1::CalibrationFacts& facts, v1::Calibration& out);

/// Same as take_calibration(), for a camera.
[[nodiscard]] Status take_camera(const v1::CalibrateCameraReport& report, v1::Calibration& out);

}  // namespace hydroprint::daemon
