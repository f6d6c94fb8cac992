#include "sim/image/io/header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "sim/image/io/image_file.h"

namespace hydroprint::image {
namespace {

using Signature = std::array<unsigned char, 8>;

std::uint32_t big_endian(const unsigned char* bytes, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8 | bytes[i];
  return value;
}

std::uint32_t crc32(std::uint32_t crc, const unsigned char* bytes, std::size_t count) {
  static const auto table = [] {
    std::array<std::uint32_t, 256> crc_table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = value >> 1 ^ (value & 1 ? 0xEDB88320U : 0);
      crc_table[i] = value;
    }
    return crc_table;
  }();
  for (std::size_t i = 0; i < count; ++i) crc = table[(crc ^ bytes[i]) & 255] ^ crc >> 8;
  return crc;
}

std::string at_byte(const std::string& name, std::int64_t offset) {
  return fmt::format("{}, byte {}: ", name, offset);
}

/// Compares the checksum of a PNG chunk's type and data with the stored one.
bool is_chunk_sound(const ByteSource& bytes, std::int64_t offset, std::int64_t length) {
  std::vector<unsigned char> buffer(1 << 16);
  std::uint32_t crc = ~0U;
  for (std::int64_t at = offset + 4, end = offset + 8 + length; at < end;) {
    const auto wanted = static_cast<std::size_t>(std::min<std::int64_t>(end - at, 1 << 16));
    if (bytes.read(buffer.data(), wanted, at) != wanted) return false;
    crc = crc32(crc, buffer.data(), wanted);
    at += static_cast<std::int64_t>(wanted);
  }
  Signature stored{};
  return bytes.read(stored.data(), 4, offset + 8 + length) == 4 &&
         big_endian(stored.data(), 4) == ~crc;
}

/// @return true if the image has an ICC profile
Result<bool> check_png(const ByteSource& bytes, const std::string& name) {
  Signature head{};
  if (bytes.read(head.data(), 8, 16) != 8) {
    return fail(Code::kDataLoss, at_byte(name, 16) +
                                     "the PNG ends within its header. Download or export "
                                     "the file again");
  }
  HP_RETURN_IF_ERROR(check_size(big_endian(head.data(), 4), big_endian(head.data() + 4, 4),
                                bytes.size, Format::kPng, name));
  bool has_profile = false;
  for (std::int64_t at = 8;;) {
    if (bytes.read(head.data(), 8, at) != 8) {
      return fail(Code::kDataLoss,
                  at_byte(name, at) +
                      "the PNG ends before its last chunk. Download or export the file again");
    }
    const std::int64_t length = big_endian(head.data(), 4);
    const bool is_last = std::memcmp(head.data() + 4, "IEND", 4) == 0;
    // A wrong checksum in the last chunk does no harm.
    if (is_last) return has_profile;
    has_profile = has_profile || std::memcmp(head.data() + 4, "iCCP", 4) == 0;
    if (at + 12 + length > bytes.size || !is_chunk_sound(bytes, at, length)) {
      return fail(Code::kDataLoss, at_byte(name, at) +
                                       "a chunk of the PNG is truncated or "
                                       "damaged. Download or export the file again");
    }
    at += 12 + length;
  }
}

/// Finds the frame header and checks the image's size, because the decoder of progressive JPEGs
/// allocates memory for the whole image when it opens the file.
Status check_jpeg(const ByteSource& bytes, const std::string& name) {
  Signature head{};
  for (std::int64_t at = 2; bytes.read(head.data(), 4, at) == 4;) {
    if (head[0] != 0xFF) break;
    const int marker = head[1];
    if (marker == 0xFF) {
      ++at;
      continue;
    }
    const bool is_frame =
        marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (is_frame) {
      if (bytes.read(head.data(), 4, at + 5) != 4) break;
      return check_size(big_endian(head.data() + 2, 2), big_endian(head.data(), 2), bytes.size,
                        Format::kJpeg, name);
    }
    if (marker == 0xDA || marker == 0xD9) break;
    at += 2 + big_endian(head.data() + 2, 2);
  }
  return fail(Code::kDataLoss,
              name + ": the JPEG has no readable header. Download or export the file again");
}

}  // namespace

const char* decoder_name(Format format) {
  switch (format) {
    case Format::kPng:
      return "png";
    case Format::kJpeg:
      return "jpeg";
    case Format::kTiff:
      return "tiff";
  }
  return "";
}

Result<FileHeader> check_header(const ByteSource& bytes, const std::string& name) {
  Signature head{};
  const std::size_t got = bytes.read(head.data(), head.size(), 0);
  const auto starts = [&](const char* magic, std::size_t length) {
    return got >= length && std::memcmp(head.data(), magic, length) == 0;
  };
  if (starts("\x89PNG\r\n\x1a\n", 8)) {
    HP_ASSIGN_OR_RETURN(const bool has_profile, check_png(bytes, name));
    return FileHeader{Format::kPng, has_profile};
  }
  if (starts("\xFF\xD8\xFF", 3)) {
    HP_RETURN_IF_ERROR(check_jpeg(bytes, name));
    return FileHeader{Format::kJpeg};
  }
  if (starts("II*\0", 4) || starts("MM\0*", 4) || starts("II+\0", 4) || starts("MM\0+", 4)) {
    return FileHeader{Format::kTiff};
  }
  return fail(Code::kInvalidArgument,
              name + ": not a PNG, JPEG or TIFF image. Use an image in one of these formats");
}

Status check_size(std::int64_t width, std::int64_t height, std::int64_t file_size, Format format,
                  const std::string& name) {
  const std::string size = fmt::format("{} x {} pixels", width, height);
  if (width < 1 || height < 1) {
    return fail(Code::kDataLoss,
                fmt::format("{}, header: impossible size, {}. Download or export the file again",
                            name, size));
  }
  if (width > kMaxImageSide_px || height > kMaxImageSide_px || width * height > kMaxImageArea_px) {
    return fail(
        Code::kOutOfRange,
        fmt::format("{}, header: {} exceed the limit of {} pixels per side or {} million in all. "
                    "Scale the image down",
                    name, size, kMaxImageSide_px, kMaxImageArea_px / 1'000'000));
  }
  // Deflate compresses at most 1032 to 1, and here a pixel has at least one bit; the other formats
  // compress less than 5000 to 1.
  const std::int64_t pixels_per_byte = format == Format::kPng ? 8 * 1032 : 8 * 5000;
  if (width * height / pixels_per_byte > file_size) {
    return fail(Code::kDataLoss,
                fmt::format("{}, header: announces {} in a file of {} bytes, "
                            "which cannot hold them. Download or export the file again",
                            name, size, file_size));
  }
  return {};
}

}  // namespace hydroprint::image
