#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint::cli {

/// Asks for a line that is not shown while it is typed; where standard input is no terminal, its
/// next line is taken, without asking.
/// @return kCancelled on Ctrl-C; kInvalidArgument if there is none
[[nodiscard]] Result<std::string> ask_secret(const std::string& prompt);

/// As above, but shown.
[[nodiscard]] Result<std::string> ask(const std::string& prompt);

/// Asks for a new password, twice on a terminal.
[[nodiscard]] Result<std::string> ask_new_password();

}  // namespace hydroprint::cli
