#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "sim/base/context.h"
#include "sim/base/result.h"

namespace hydroprint {

/// A file's fingerprint and size.
struct FileDigest {
  std::string sha256;  ///< 64 lower-case hex digits
  std::int64_t size_bytes = 0;
};

/// Reads a regular file once. Refuses what open_input_file refuses; kCancelled when cancelled.
[[nodiscard]] Result<FileDigest> digest_file(const std::filesystem::path& path,
                                             const Context& context = {});

}  // namespace hydroprint
