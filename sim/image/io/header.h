#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::image {

/// A file or a part of one; `read` copies up to `count` bytes from `offset` and returns the number
/// copied.
struct ByteSource {
  std::int64_t size = 0;
  std::function<std::size_t(void* to, std::size_t count, std::int64_t offset)> read;
};

/// The supported formats, named after their decoders.
enum class Format { kPng, kJpeg, kTiff };
[[nodiscard]] const char* decoder_name(Format format);

/// What the header of a file says.
struct FileHeader {
  Format format = Format::kPng;
  bool has_profile =
      false;  ///< a PNG with an ICC profile, which its decoder drops if it is damaged
};

/// Detects the format from the first bytes. Before a decoder sees them, rejects PNG and JPEG images
/// whose announced size exceeds the limits of image_file.h or does not fit the file's size, and PNG
/// images with truncated or damaged chunks. (check_size() checks TIFF, because its decoder opens
/// files lazily.)
[[nodiscard]] Result<FileHeader> check_header(const ByteSource& bytes, const std::string& name);

/// Rejects sizes beyond the limits, and sizes for which `file_size` bytes are too few.
[[nodiscard]] Status check_size(std::int64_t width, std::int64_t height, std::int64_t file_size,
                                Format format, const std::string& name);

}  // namespace hydroprint::image
