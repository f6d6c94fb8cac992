#pragma once

#include <filesystem>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::loop {

/// Sends one line to a virtual rig's control socket. @return its reply, one line; kUnavailable if
/// the rig does not answer, kInvalidArgument if it refuses
[[nodiscard]] Result<std::string> talk(const std::filesystem::path& control,
                                       const std::string& line);

/// Quotes a path for the rig's control language, including spaces.
[[nodiscard]] std::string quoted(const std::filesystem::path& path);

}  // namespace hydroprint::loop
