#pragma once

#include <string>

#include "client/calibration.h"

namespace hydroprint::cli {

/// Describes a calibration in a few lines: its kind, accuracy, assumptions, and whether it is still
/// valid.
[[nodiscard]] std::string text_of(const client::Calibration& calibration);

}  // namespace hydroprint::cli
