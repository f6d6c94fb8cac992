#pragma once

#include <cstdint>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// One line of a check of the installation.
struct CheckLine {
  enum class Verdict : std::uint8_t { kOk, kNote, kFault };

  Verdict verdict = Verdict::kOk;
  std::string what;    ///< that was checked: "state folder"
  std::string detail;  ///< of a fault: what is wrong, and the remedy
};

/// Returns the line of a check with this result: its detail, or its error.
[[nodiscard]] inline CheckLine check_line(std::string what, const Result<std::string>& result) {
  return result ? CheckLine{CheckLine::Verdict::kOk, std::move(what), *result}
                : CheckLine{CheckLine::Verdict::kFault, std::move(what), result.error().message};
}

}  // namespace hydroprint::daemon
