#pragma once

#include <string>

namespace hydroprint {

/// The text on one line: control characters, line ends among them, become blanks. For what is said
/// of other people's files and words, which may hold any.
[[nodiscard]] std::string one_line(std::string text);

}  // namespace hydroprint
