#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::worker {

/// A file's fingerprint and size.
struct Digest {
  std::string sha256;  ///< 64 lower-case hex digits
  std::uint64_t size_bytes = 0;
};

/// Reads a regular file once. Refuses what is missing, unreadable or no regular file.
[[nodiscard]] Result<Digest> digest_file(const std::filesystem::path& path);

}  // namespace hydroprint::worker
