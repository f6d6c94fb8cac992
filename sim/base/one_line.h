#pragma once

#include <string>

namespace hydroprint {

/// Puts the text on one line: control characters, including line ends, become blanks. For messages
/// that quote untrusted files or input.
[[nodiscard]] std::string one_line(std::string text);

}  // namespace hydroprint
