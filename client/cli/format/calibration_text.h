#pragma once

#include <string>

#include "client/calibration.h"

namespace hydroprint::cli {

/// A few lines for people: what it is, how good, what it does not know, and whether it still holds.
[[nodiscard]] std::string text_of(const client::Calibration& calibration);

}  // namespace hydroprint::cli
