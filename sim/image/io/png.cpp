#include "sim/image/io/png.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

#include "sim/base/check.h"
#include "sim/image/io/grey16.h"
#include "sim/image/io/printer_image.h"

namespace hydroprint::image {
namespace {

using Bytes = std::vector<unsigned char>;

constexpr std::size_t kBandBytes = std::size_t{1} << 20;  ///< of a band, before compression
constexpr double kMmPerInch = 25.4;

/// Filters of the PNG specification (section 9.2): difference from the same byte of the pixel on
/// the left, or above.
enum Filter : unsigned char { kSub = 1, kUp = 2 };

/// Samples as stored in memory, row by row.
struct Rows {
  const std::uint8_t* samples = nullptr;
  int width = 0, height = 0, channels = 3;

  [[nodiscard]] std::size_t bytes() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels);
  }
  [[nodiscard]] const std::uint8_t* row(int y) const { return samples + bytes() * y; }
};

/// Rows [first, last) of the image, compressed, and the checksum of their uncompressed bytes.
struct Band {
  int first = 0, last = 0;
  Bytes deflated;
  uLong adler = 0;
  std::size_t raw_bytes = 0;
};

void append_u32(Bytes& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) {
    out.push_back(static_cast<unsigned char>(value >> shift));
  }
}

void append_chunk(Bytes& out, std::string_view type, std::span<const unsigned char> data) {
  append_u32(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  append_u32(out, static_cast<std::uint32_t>(
                      crc32_z(0, out.data() + start, static_cast<z_size_t>(out.size() - start))));
}

/// Returns the sum of the absolute values of a row's bytes, taken as signed numbers. Rows with a
/// smaller sum compress better.
long weight(std::span<const unsigned char> row) {
  long sum = 0;
  for (const unsigned char byte : row) sum += std::abs(static_cast<signed char>(byte));
  return sum;
}

/// Appends the number of the better of the two filters, and the row filtered with it.
void append_row(Bytes& out, const unsigned char* row, const unsigned char* above, std::size_t bytes,
                std::size_t pixel_bytes) {
  const std::size_t start = out.size();
  out.resize(start + 1 + bytes);
  unsigned char* to = &out[start];
  to[0] = kUp;
  for (std::size_t i = 0; i < bytes; ++i) {
    to[1 + i] = static_cast<unsigned char>(row[i] - (above != nullptr ? above[i] : 0));
  }
  const long up = weight({to + 1, bytes});
  if (up == 0) return;
  Bytes sub(row, row + bytes);
  for (std::size_t i = pixel_bytes; i < bytes; ++i) {
    sub[i] = static_cast<unsigned char>(row[i] - row[i - pixel_bytes]);
  }
  if (weight(sub) >= up) return;
  to[0] = kSub;
  std::copy(sub.begin(), sub.end(), to + 1);
}

Bytes filtered(const Rows& image, int first, int last) {
  Bytes out;
  out.reserve((image.bytes() + 1) * static_cast<std::size_t>(last - first));
  for (int y = first; y < last; ++y) {
    append_row(out, image.row(y), y > 0 ? image.row(y - 1) : nullptr, image.bytes(),
               static_cast<std::size_t>(image.channels));
  }
  return out;
}

/// Compresses bytes so that the next compressed block can be appended directly.
/// @return false if there is not enough memory
bool deflate(Bytes& raw, bool is_end, Bytes& out) {
  z_stream stream{};
  constexpr int kRawDeflate = -15;
  if (deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, kRawDeflate, 9, Z_DEFAULT_STRATEGY) != Z_OK) {
    return false;
  }
  constexpr std::size_t kFlush = 16;  // bytes; more than a flush adds
  out.resize(deflateBound(&stream, static_cast<uLong>(raw.size())) + kFlush);
  stream.next_in = raw.data();
  stream.avail_in = static_cast<uInt>(raw.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  const int done = ::deflate(&stream, is_end ? Z_FINISH : Z_SYNC_FLUSH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return done == (is_end ? Z_STREAM_END : Z_OK) && stream.avail_in == 0;
}

std::vector<Band> bands_of(const Rows& image) {
  const std::size_t row_bytes = image.bytes() + 1;
  const int rows = static_cast<int>(std::clamp<std::size_t>(kBandBytes / row_bytes, 1, 1 << 20));
  std::vector<Band> bands;
  for (int y = 0; y < image.height; y += rows) {
    Band& band = bands.emplace_back();
    band.first = y;
    band.last = std::min(y + rows, image.height);
  }
  return bands;
}

Status compress(const Rows& image, std::vector<Band>& bands, const Context& context) {
  return parallel_for(context, {}, bands.size(), [&](std::size_t b) -> Status {
    Band& band = bands[b];
    Bytes raw = filtered(image, band.first, band.last);
    band.raw_bytes = raw.size();
    band.adler = adler32_z(1, raw.data(), raw.size());
    if (deflate(raw, b + 1 == bands.size(), band.deflated)) return {};
    return fail(Code::kInternal, "PNG: out of memory. Free some memory", ErrorReason::MEMORY_LIMIT);
  });
}

/// Returns the PNG signature and the header chunk. `depth` is the number of bits per channel and
/// `colour` the colour type, as numbered in the specification.
Bytes start(const Rows& image, unsigned char depth, unsigned char colour) {
  Bytes header;
  append_u32(header, static_cast<std::uint32_t>(image.width));
  append_u32(header, static_cast<std::uint32_t>(image.height));
  header.insert(header.end(), {depth, colour, 0, 0, 0});
  Bytes out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  append_chunk(out, "IHDR", header);
  return out;
}

Bytes resolution(double dpi) {
  const auto per_metre = static_cast<std::uint32_t>(std::lround(1000 * dpi / kMmPerInch));
  Bytes out;
  append_u32(out, per_metre);
  append_u32(out, per_metre);
  out.push_back(1);  // unit: metre
  return out;
}

/// Returns the zlib stream of the compressed bands: header, bands, checksum of all.
Bytes join(const std::vector<Band>& bands) {
  Bytes out = {0x78, 0x01};
  uLong adler = 1;
  for (const Band& band : bands) {
    out.insert(out.end(), band.deflated.begin(), band.deflated.end());
    adler = adler32_combine(adler, band.adler, static_cast<z_off_t>(band.raw_bytes));
  }
  append_u32(out, static_cast<std::uint32_t>(adler));
  return out;
}

/// Appends the chunk that declares the colour space.
Status append_colours(Bytes& out, const std::string& icc_profile) {
  if (icc_profile.empty()) {
    append_chunk(out, "sRGB", std::array<unsigned char, 1>{0});
    return {};
  }
  Bytes chunk = {'p', 'r', 'i', 'n', 't', 'e', 'r', 0, 0};
  auto bytes = compressBound(static_cast<uLong>(icc_profile.size()));
  const std::size_t start = chunk.size();
  chunk.resize(start + bytes);
  if (::compress(chunk.data() + start, &bytes, reinterpret_cast<const Bytef*>(icc_profile.data()),
                 static_cast<uLong>(icc_profile.size())) != Z_OK) {
    return fail(Code::kInternal, "PNG: out of memory. Free some memory", ErrorReason::MEMORY_LIMIT);
  }
  chunk.resize(start + bytes);
  append_chunk(out, "iCCP", chunk);
  return {};
}

/// Appends IDAT chunks. Each may contain any part of the stream; its length field has 31 bits.
void append_data(Bytes& out, std::span<const unsigned char> stream) {
  constexpr std::size_t kMost = std::size_t{1} << 24;
  while (!stream.empty()) {
    const auto part = stream.first(std::min(kMost, stream.size()));
    append_chunk(out, "IDAT", part);
    stream = stream.subspan(part.size());
  }
}

/// Appends the image data and the end chunk.
Status append_pixels(Bytes& out, const Rows& image, const Context& context) {
  HP_ASSIGN_OR_RETURN(const Bytes stream, compress_rows(image.samples, image.width, image.height,
                                                        image.channels, context));
  append_data(out, stream);
  append_chunk(out, "IEND", {});
  return {};
}

Result<Bytes> encode(const Rows& image, double dpi, const std::string& icc_profile,
                     const Context& context) {
  Bytes out = start(image, 8, 2);
  HP_RETURN_IF_ERROR(append_colours(out, icc_profile));
  append_chunk(out, "pHYs", resolution(dpi));
  HP_RETURN_IF_ERROR(append_pixels(out, image, context));
  return out;
}

}  // namespace

Result<std::vector<unsigned char>> compress_rows(const std::uint8_t* samples, int width, int height,
                                                 int channels, const Context& context) {
  HP_CHECK(width > 0);
  HP_CHECK(height > 0);
  const Rows rows{samples, width, height, channels};
  std::vector<Band> bands = bands_of(rows);
  HP_RETURN_IF_ERROR(compress(rows, bands, context));
  return join(bands);
}

Result<std::vector<unsigned char>> encode_png(const RgbImage& image, double dpi,
                                              const Context& context) {
  HP_CHECK(image.rgb.size() == 3 * static_cast<std::size_t>(image.width) * image.height);
  return encode({image.rgb.data(), image.width, image.height, 3}, dpi, {}, context);
}

Result<std::vector<unsigned char>> encode_png(const PrinterImage& image, double dpi,
                                              const std::string& icc_profile,
                                              const Context& context) {
  HP_CHECK(image.samples.size() == image.row_bytes() * image.height);
  return encode({image.samples.data(), image.width, image.height, image.channels}, dpi, icc_profile,
                context);
}

Result<std::vector<unsigned char>> encode_png(const Grey16Image& image, const Context& context) {
  HP_CHECK(image.grey.size() == static_cast<std::size_t>(image.width) * image.height);
  Bytes bytes;  // big-endian
  bytes.reserve(2 * image.grey.size());
  for (const std::uint16_t value : image.grey) {
    bytes.push_back(static_cast<unsigned char>(value >> 8U));
    bytes.push_back(static_cast<unsigned char>(value & 0xffU));
  }
  const Rows rows{bytes.data(), image.width, image.height, 2};
  Bytes out = start(rows, 16, 0);
  HP_RETURN_IF_ERROR(append_pixels(out, rows, context));
  return out;
}

}  // namespace hydroprint::image
