#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::image {

/// Bytes of a file or of a part of one; `read` fills up to `count` bytes from `offset` and returns
/// how many there were.
struct ByteSource {
  std::int64_t size = 0;
  std::function<std::size_t(void* to, std::size_t count, std::int64_t offset)> read;
};

/// The formats understood, by the names of their decoders.
enum class Format { kPng, kJpeg, kTiff };
[[nodiscard]] const char* decoder_name(Format format);

/// Tells the format by the first bytes and, before any decoder sees them, refuses PNG and JPEG that
/// announce more than the limits of image_file.h or more than so many bytes can hold, and PNG whose
/// chunks are cut short or damaged. (TIFF is left to check_size: its decoder opens it lazily.)
[[nodiscard]] Result<Format> check_header(const ByteSource& bytes, const std::string& name);

/// Refuses sizes beyond the limits or beyond what `file_size` bytes can hold.
[[nodiscard]] Status check_size(std::int64_t width, std::int64_t height, std::int64_t file_size,
                                Format format, const std::string& name);

}  // namespace hydroprint::image
