#pragma once

#include <filesystem>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::loop {

/// Says one line to a virtual rig's control socket. @return its reply, of one line; kUnavailable if
/// nobody answers there, kInvalidArgument if the rig refuses
[[nodiscard]] Result<std::string> talk(const std::filesystem::path& control,
                                       const std::string& line);

/// A path as the rig reads it, blanks and all.
[[nodiscard]] std::string quoted(const std::filesystem::path& path);

}  // namespace hydroprint::loop
