#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

#include "sim/base/result.h"

namespace hydroprint {

/// Opens a regular file for reading bytes. Refuses what is missing (kNotFound), unreadable
/// (kPermissionDenied), a folder or a device (kInvalidArgument).
[[nodiscard]] Result<std::ifstream> open_input_file(const std::filesystem::path& path);

/// The whole content of a file of at most `max_bytes`, for small files that people write.
/// Refuses what open_input_file refuses and what is too large (kOutOfRange).
[[nodiscard]] Result<std::string> read_text_file(const std::filesystem::path& path,
                                                 std::size_t max_bytes);

}  // namespace hydroprint
