#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint::cli {

/// Prompts for a line without echo. If standard input is not a terminal, reads its next line
/// without a prompt.
/// @return kCancelled on Ctrl-C; kInvalidArgument at the end of input
[[nodiscard]] Result<std::string> ask_secret(const std::string& prompt);

/// Same as ask_secret(), with echo.
[[nodiscard]] Result<std::string> ask(const std::string& prompt);

/// Prompts for a new password, twice on a terminal.
[[nodiscard]] Result<std::string> ask_new_password();

}  // namespace hydroprint::cli
