#include "sim/mesh/read/stl_colours.h"

#include <algorithm>
#include <optional>

namespace hydroprint::mesh {
namespace {

constexpr std::uint16_t kFlag = 1U << 15;

/// Returns the colour of three fields of five bits, the lowest first.
Eigen::Vector3f five_bits(std::uint16_t value) {
  return Eigen::Vector3f(static_cast<float>(value & 31), static_cast<float>(value >> 5 & 31),
                         static_cast<float>(value >> 10 & 31)) /
         31;
}

/// Returns the colour of all facets from a Magics header; nullopt if it has none.
std::optional<Eigen::Vector3f> magics_colour(std::string_view header) {
  constexpr std::string_view kMark = "COLOR=";
  const auto at = header.find(kMark);
  if (at == header.npos || at + kMark.size() + 3 > header.size()) return {};
  Eigen::Vector3f colour;
  for (std::size_t k = 0; k < 3; ++k)
    colour[static_cast<int>(k)] =
        static_cast<float>(static_cast<unsigned char>(header[at + kMark.size() + k])) / 255;
  return colour;
}

}  // namespace

StlColours stl_colours(std::string_view header, const std::vector<std::uint16_t>& attributes) {
  StlColours out;
  const bool none_written =
      std::ranges::all_of(attributes, [](std::uint16_t value) { return value == 0; });
  if (const auto whole = magics_colour(header)) {
    out.facets.reserve(attributes.size());
    for (const auto value : attributes)  // all 0: a writer that knows only the header's colour
      out.facets.push_back(none_written || (value & kFlag) != 0 ? *whole : five_bits(value));
    return out;
  }
  const bool any = std::ranges::any_of(attributes, [](auto value) { return (value & kFlag) != 0; });
  if (!any) {
    out.odd_attributes = !none_written;
    return out;
  }
  for (const auto value : attributes) {
    const bool coloured = (value & kFlag) != 0;
    out.facets.push_back(coloured ? five_bits(value).reverse().eval() : Eigen::Vector3f::Ones());
    out.uncoloured += coloured ? 0 : 1;
  }
  return out;
}

}  // namespace hydroprint::mesh
