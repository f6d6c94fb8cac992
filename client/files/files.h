#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>

#include "sim/base/file_digest.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// Reports progress: the number of bytes transferred, and their total number.
using ByteProgress = std::function<void(std::int64_t done_bytes, std::int64_t total_bytes)>;

/// Reads a regular file, starting at byte `offset`, in pieces of at most 64 KiB until the end or
/// until `take` returns false.
/// @return kNotFound, kPermissionDenied or kInvalidArgument (not a regular file) with the file name
[[nodiscard]] Status read_file(const std::filesystem::path& path, std::int64_t offset,
                               const std::function<bool(std::string_view bytes)>& take);

/// Computes the size and SHA-256 of a file. Returns the errors of open_input_file(), and kCancelled
/// when stopped.
[[nodiscard]] Result<FileDigest> digest_file(const std::filesystem::path& path,
                                             const std::stop_token& stop);

/// Reads a whole text file; kInvalidArgument if it is longer than `max_bytes`.
[[nodiscard]] Result<std::string> read_text(const std::filesystem::path& path,
                                            std::int64_t max_bytes);

}  // namespace hydroprint::client
