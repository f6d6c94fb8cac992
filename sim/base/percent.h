#pragma once

#include <fmt/format.h>

#include <string>

namespace hydroprint {

/// A share for people, with three digits: "12.3 %".
[[nodiscard]] inline std::string percent(double share) {
  return fmt::format("{:.3g} %", 100 * share);
}

}  // namespace hydroprint
