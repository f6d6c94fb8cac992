#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "sim/base/result.h"

namespace hydroprint {

/// The whole content of a regular file of at most `max_bytes`, for small files that people write.
/// Refuses what is missing (kNotFound), unreadable (kPermissionDenied), a folder or a device
/// (kInvalidArgument) or too large (kOutOfRange).
[[nodiscard]] Result<std::string> read_text_file(const std::filesystem::path& path,
                                                 std::size_t max_bytes);

}  // namespace hydroprint
