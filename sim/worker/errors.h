#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint::worker {

/// The text on one line: control characters, line ends among them, become blanks.
[[nodiscard]] std::string one_line(std::string text);

/// Tells of a failure: one line on stderr and, if `json`, the same as
/// {"error":{"code","reason","message","metadata","exit_status"}} on stdout.
void tell(const Error& error, ExitStatus status, bool json);

}  // namespace hydroprint::worker
