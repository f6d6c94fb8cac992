#pragma once

#include <cstdint>
#include <filesystem>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// Returns the error ASSET_TOO_LARGE, with metadata `max_bytes`.
[[nodiscard]] tl::unexpected<Error> asset_too_large(Code code, std::int64_t max_bytes);

/// Returns the size of a file; 0 if it does not exist.
[[nodiscard]] std::int64_t size_on_disk(const std::filesystem::path& path);

}  // namespace hydroprint::daemon
