#include "sim/mesh/read/ply_body.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "sim/mesh/read/numbers.h"

namespace hydroprint::mesh {
namespace {

double decode(std::uint64_t bits, const PlyType& type) {
  if (type.kind == PlyType::Kind::kReal && type.bytes == 4)
    return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
  if (type.kind == PlyType::Kind::kReal) return std::bit_cast<double>(bits);
  if (type.kind == PlyType::Kind::kUnsigned) return static_cast<double>(bits);
  const auto shift = 64 - 8 * type.bytes;
  return static_cast<double>(static_cast<std::int64_t>(bits << shift) >> shift);
}

}  // namespace

void PlyBody::next_item() {
  if (format_ != PlyHeader::Format::kAscii) return;
  do {
    const auto end = std::min(rest_.find(line_end_), rest_.size());
    item_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (item_.ends_with('\r')) item_.remove_suffix(1);
  } while (item_.find_first_not_of(" \t") == item_.npos && !rest_.empty());
}

std::optional<double> PlyBody::next(const PlyType& type) {
  if (format_ == PlyHeader::Format::kAscii) {
    const std::string_view word = next_word(item_);
    const auto number = parse_number(word);
    return !number && is_not_finite(word) ? std::nan("") : number;
  }
  if (rest_.size() < type.bytes) return std::nullopt;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < type.bytes; ++i) {
    const auto from = format_ == PlyHeader::Format::kLittle ? type.bytes - 1 - i : i;
    bits = bits << 8 | static_cast<unsigned char>(rest_[from]);
  }
  rest_.remove_prefix(type.bytes);
  return decode(bits, type);
}

}  // namespace hydroprint::mesh
