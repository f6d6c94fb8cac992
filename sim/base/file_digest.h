#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "sim/base/context.h"
#include "sim/base/result.h"

namespace hydroprint {

/// A file's hash and size.
struct FileDigest {
  std::string sha256;  ///< 64 lower-case hex digits
  std::int64_t size_bytes = 0;
};

/// Reads a regular file once. Fails as open_input_file() does, or with kCancelled.
[[nodiscard]] Result<FileDigest> digest_file(const std::filesystem::path& path,
                                             const Context& context = {});

}  // namespace hydroprint
