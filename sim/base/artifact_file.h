#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::image {

/// Writes a whole file atomically: to a temporary file in the same folder, which is synced and then
/// renamed. Errors: kResourceExhausted (reason DISK_FULL, or OUTPUT_LIMIT if the file would exceed
/// the process's limit on file sizes), kNotFound (no such folder), kPermissionDenied or kInternal.
/// Leaves no temporary file behind after an error.
[[nodiscard]] Status write_artifact(const std::filesystem::path& path,
                                    std::span<const unsigned char> bytes);

/// Same as write_artifact() above, for text.
[[nodiscard]] Status write_artifact(const std::filesystem::path& path, std::string_view text);

}  // namespace hydroprint::image
