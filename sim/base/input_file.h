#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>

#include "sim/base/result.h"

namespace hydroprint {

/// Opens a regular file for reading bytes. Errors: kNotFound if it is missing, kPermissionDenied if
/// it is unreadable, kInvalidArgument if it is a folder or a device.
[[nodiscard]] Result<std::ifstream> open_input_file(const std::filesystem::path& path);

/// Returns the whole content of a file of at most `max_bytes`, for small hand-written files.
/// Returns the errors of open_input_file(), and kOutOfRange if the file is too large.
[[nodiscard]] Result<std::string> read_text_file(const std::filesystem::path& path,
                                                 std::size_t max_bytes);

}  // namespace hydroprint
