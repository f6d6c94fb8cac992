#include "sim/image/png.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>

namespace hydroprint::image {
namespace {

using Bytes = std::vector<unsigned char>;

constexpr std::size_t kBandBytes = std::size_t{1} << 20;  ///< not compressed
constexpr double kMmPerInch = 25.4;

/// Filters of the PNG specification (section 9.2): a byte less the one to its left, or above it.
enum Filter : unsigned char { kSub = 1, kUp = 2 };

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
void append_row(Bytes& out, const unsigned char* row, const unsigned char* above,
                std::size_t bytes) {
  constexpr std::size_t kPixel = 3;
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
  for (std::size_t i = kPixel; i < bytes; ++i) {
    sub[i] = static_cast<unsigned char>(row[i] - row[i - kPixel]);
  }
  if (weight(sub) >= up) return;
  to[0] = kSub;
  std::copy(sub.begin(), sub.end(), to + 1);
}

Bytes filtered(const RgbImage& image, int first, int last) {
  const std::size_t bytes = 3 * static_cast<std::size_t>(image.width);
  Bytes out;
  out.reserve((bytes + 1) * static_cast<std::size_t>(last - first));
  for (int y = first; y < last; ++y) {
    append_row(out, image.at(0, y), y > 0 ? image.at(0, y - 1) : nullptr, bytes);
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

std::vector<Band> bands_of(const RgbImage& image) {
  const std::size_t row_bytes = 3 * static_cast<std::size_t>(image.width) + 1;
  const int rows = static_cast<int>(std::clamp<std::size_t>(kBandBytes / row_bytes, 1, 1 << 20));
  std::vector<Band> bands;
  for (int y = 0; y < image.height; y += rows) {
    Band& band = bands.emplace_back();
    band.first = y;
    band.last = std::min(y + rows, image.height);
  }
  return bands;
}

Status compress(const RgbImage& image, std::vector<Band>& bands, const Context& context) {
  return parallel_for(context, {}, bands.size(), [&](std::size_t b) -> Status {
    Band& band = bands[b];
    Bytes raw = filtered(image, band.first, band.last);
    band.raw_bytes = raw.size();
    band.adler = adler32_z(1, raw.data(), raw.size());
    if (deflate(raw, b + 1 == bands.size(), band.deflated)) return {};
    return fail(Code::kInternal, "PNG: out of memory. Lower the dpi", "OUT_OF_MEMORY");
  });
}

Bytes header(const RgbImage& image) {
  Bytes out;
  append_u32(out, static_cast<std::uint32_t>(image.width));
  append_u32(out, static_cast<std::uint32_t>(image.height));
  out.insert(out.end(), {8, 2, 0, 0, 0});  // 8 bits, RGB
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

}  // namespace

Result<std::vector<unsigned char>> encode_png(const RgbImage& image, double dpi,
                                              const Context& context) {
  std::vector<Band> bands = bands_of(image);
  HP_RETURN_IF_ERROR(compress(image, bands, context));
  Bytes out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  append_chunk(out, "IHDR", header(image));
  append_chunk(out, "sRGB", std::array<unsigned char, 1>{0});
  append_chunk(out, "pHYs", resolution(dpi));
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
  return out;
}

}  // namespace hydroprint::image
