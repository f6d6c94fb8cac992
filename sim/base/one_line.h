#pragma once

#include <string>

namespace hydroprint {

/// Puts the text on one line of valid UTF-8: control characters, including line ends, become blanks,
/// and bytes that are not UTF-8 become U+FFFD. For messages that quote untrusted files or input.
[[nodiscard]] std::string one_line(std::string text);

}  // namespace hydroprint
