#include "sim/image/png.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>

#include "sim/image/grey16.h"

namespace hydroprint::image {
namespace {

using Bytes = std::vector<unsigned char>;

constexpr std::size_t kBandBytes = std::size_t{1} << 20;  ///< not compressed
constexpr double kMmPerInch = 25.4;

/// Filters of the PNG specification (section 9.2): a byte less the one to its left, or above it.
enum Filter : unsigned char { kSub = 1, kUp = 2 };

/// An image's bytes, row after row, without padding.
struct Rows {
  int width = 0, height = 0;
  std::size_t pixel = 3;  ///< bytes of one
  const unsigned char* bytes = nullptr;

  [[nodiscard]] std::size_t row_bytes() const { return pixel * static_cast<std::size_t>(width); }
  [[nodiscard]] const unsigned char* row(int y) const {
    return bytes + row_bytes() * static_cast<std::size_t>(y);
  }
};

/// Rows [first, last) of the image, compressed, and the checksum of what they were before that.
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

/// How far a row's bytes are from zero, taken as signed: the less, the better they compress.
long weight(std::span<const unsigned char> row) {
  long sum = 0;
  for (const unsigned char byte : row) sum += std::abs(static_cast<signed char>(byte));
  return sum;
}

/// One row, filtered the better of two ways, behind the number of that filter.
void append_row(Bytes& out, const unsigned char* row, const unsigned char* above, std::size_t bytes,
                std::size_t pixel) {
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
  for (std::size_t i = pixel; i < bytes; ++i) {
    sub[i] = static_cast<unsigned char>(row[i] - row[i - pixel]);
  }
  if (weight(sub) >= up) return;
  to[0] = kSub;
  std::copy(sub.begin(), sub.end(), to + 1);
}

Bytes filtered(const Rows& rows, int first, int last) {
  const std::size_t bytes = rows.row_bytes();
  Bytes out;
  out.reserve((bytes + 1) * static_cast<std::size_t>(last - first));
  for (int y = first; y < last; ++y) {
    append_row(out, rows.row(y), y > 0 ? rows.row(y - 1) : nullptr, bytes, rows.pixel);
  }
  return out;
}

/// Compresses bytes so that what is compressed next can be put behind them as it is.
/// @return false if memory does not suffice
bool deflate(Bytes& raw, bool is_end, Bytes& out) {
  z_stream stream{};
  constexpr int kRawDeflate = -15;
  if (deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, kRawDeflate, 9, Z_DEFAULT_STRATEGY) != Z_OK) {
    return false;
  }
  constexpr std::size_t kFlush = 16;  // more than a flush takes
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

std::vector<Band> bands_of(const Rows& rows) {
  const int each =
      static_cast<int>(std::clamp<std::size_t>(kBandBytes / (rows.row_bytes() + 1), 1, 1 << 20));
  std::vector<Band> bands;
  for (int y = 0; y < rows.height; y += each) {
    Band& band = bands.emplace_back();
    band.first = y;
    band.last = std::min(y + each, rows.height);
  }
  return bands;
}

Status compress(const Rows& rows, std::vector<Band>& bands, const Context& context) {
  return parallel_for(context, {}, bands.size(), [&](std::size_t b) -> Status {
    Band& band = bands[b];
    Bytes raw = filtered(rows, band.first, band.last);
    band.raw_bytes = raw.size();
    band.adler = adler32_z(1, raw.data(), raw.size());
    if (deflate(raw, b + 1 == bands.size(), band.deflated)) return {};
    return fail(Code::kInternal, "PNG: out of memory. Lower the dpi", "OUT_OF_MEMORY");
  });
}

/// @param depth, colour  bits of a channel and colour type, as the specification numbers them
Bytes header(const Rows& rows, unsigned char depth, unsigned char colour) {
  Bytes out;
  append_u32(out, static_cast<std::uint32_t>(rows.width));
  append_u32(out, static_cast<std::uint32_t>(rows.height));
  out.insert(out.end(), {depth, colour, 0, 0, 0});
  return out;
}

Bytes resolution(double dpi) {
  const auto per_metre = static_cast<std::uint32_t>(std::lround(1000 * dpi / kMmPerInch));
  Bytes out;
  append_u32(out, per_metre);
  append_u32(out, per_metre);
  out.push_back(1);  // the unit is the metre
  return out;
}

Bytes start(const Bytes& header) {
  Bytes out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  append_chunk(out, "IHDR", header);
  return out;
}

/// Pixels and end.
Status append_pixels(Bytes& out, const Rows& rows, const Context& context) {
  std::vector<Band> bands = bands_of(rows);
  HP_RETURN_IF_ERROR(compress(rows, bands, context));
  append_chunk(out, "IDAT", std::array<unsigned char, 2>{0x78, 0x01});  // zlib's header
  uLong adler = 1;
  for (const Band& band : bands) {
    append_chunk(out, "IDAT", band.deflated);
    adler = adler32_combine(adler, band.adler, static_cast<z_off_t>(band.raw_bytes));
  }
  Bytes checksum;
  append_u32(checksum, static_cast<std::uint32_t>(adler));
  append_chunk(out, "IDAT", checksum);
  append_chunk(out, "IEND", {});
  return {};
}

}  // namespace

Result<std::vector<unsigned char>> encode_png(const RgbImage& image, double dpi,
                                              const Context& context) {
  const Rows rows{image.width, image.height, 3, image.rgb.data()};
  Bytes out = start(header(rows, 8, 2));
  append_chunk(out, "sRGB", std::array<unsigned char, 1>{0});
  append_chunk(out, "pHYs", resolution(dpi));
  HP_RETURN_IF_ERROR(append_pixels(out, rows, context));
  return out;
}

Result<std::vector<unsigned char>> encode_png(const Grey16Image& image, const Context& context) {
  Bytes bytes;  // of a number, the higher one first
  bytes.reserve(2 * image.grey.size());
  for (const std::uint16_t value : image.grey) {
    bytes.push_back(static_cast<unsigned char>(value >> 8U));
    bytes.push_back(static_cast<unsigned char>(value & 0xffU));
  }
  const Rows rows{image.width, image.height, 2, bytes.data()};
  Bytes out = start(header(rows, 16, 0));
  HP_RETURN_IF_ERROR(append_pixels(out, rows, context));
  return out;
}

}  // namespace hydroprint::image
