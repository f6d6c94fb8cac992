#pragma once

#include <filesystem>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::loop {

/// Sends one line to a virtual rig's control socket.
/// @return its response, one line; kUnavailable if the rig does not respond, kInvalidArgument if it
///         reports an error
[[nodiscard]] Result<std::string> talk(const std::filesystem::path& control,
                                       const std::string& line);

/// Quotes a path, which may contain spaces, for the rig's control language.
[[nodiscard]] std::string quoted(const std::filesystem::path& path);

}  // namespace hydroprint::loop
