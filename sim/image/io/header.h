#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::image {

/// The bytes of a file or of a part of one; `read` copies up to `count` bytes from `offset` and
/// returns the number copied.
struct ByteSource {
  std::int64_t size = 0;
  std::function<std::size_t(void* to, std::size_t count, std::int64_t offset)> read;
};

/// The supported formats, named after their decoders.
enum class Format { kPng, kJpeg, kTiff };
[[nodiscard]] const char* decoder_name(Format format);

/// Detects the format from the first bytes. Before any decoder sees them, it refuses PNG and JPEG
/// that announce more than the limits of image_file.h or more than the file's size can hold. It
/// also refuses PNG with truncated or damaged chunks. (TIFF is left to check_size(): its decoder
/// opens it lazily.)
[[nodiscard]] Result<Format> check_header(const ByteSource& bytes, const std::string& name);

/// Refuses sizes beyond the limits or beyond what `file_size` bytes can hold.
[[nodiscard]] Status check_size(std::int64_t width, std::int64_t height, std::int64_t file_size,
                                Format format, const std::string& name);

}  // namespace hydroprint::image
