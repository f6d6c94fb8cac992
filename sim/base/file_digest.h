#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "sim/base/context.h"
#include "sim/base/result.h"

namespace hydroprint {

/// Hash and size of a file.
struct FileDigest {
  std::string sha256;  ///< 64 lower-case hex digits
  std::int64_t size_bytes = 0;
};

/// Computes the hash and size of a regular file in one pass. Returns the errors of
/// open_input_file(), and kCancelled.
[[nodiscard]] Result<FileDigest> digest_file(const std::filesystem::path& path,
                                             const Context& context = {});

}  // namespace hydroprint
