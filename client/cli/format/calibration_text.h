#pragma once

#include <string>
#include <vector>

#include "hydroprint/v1/calibration_service.pb.h"

namespace hydroprint::cli {

/// Describes a calibration in a few lines: its kind, accuracy, assumptions, and whether it is still
/// valid.
[[nodiscard]] std::string text_of(const v1::Calibration& calibration);

/// Returns the reasons why a calibration is no longer valid: "MOVED", "HOMED", "DIPPED".
[[nodiscard]] std::vector<std::string> staleness_of(const v1::Calibration& calibration);

}  // namespace hydroprint::cli
