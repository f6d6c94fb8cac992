#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::image {

/// Writes a whole file under a temporary name in the same folder, syncs it and renames it, so that
/// the name never refers to a partial file. Errors: kResourceExhausted (reason DISK_FULL, or
/// FILE_LIMIT beyond the process's limit), kNotFound (no such folder), kPermissionDenied or
/// kInternal. Nothing is left behind after an error.
[[nodiscard]] Status write_artifact(const std::filesystem::path& path,
                                    std::span<const unsigned char> bytes);

/// Same as write_artifact() above, for a text.
[[nodiscard]] Status write_artifact(const std::filesystem::path& path, std::string_view text);

}  // namespace hydroprint::image
