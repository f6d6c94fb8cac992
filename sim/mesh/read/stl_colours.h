#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string_view>
#include <vector>

namespace hydroprint::mesh {

/// Colours of a binary STL file, which the format does not define. Two dialects exist:
/// Magics (the header contains COLOR= and four bytes R G B A): the two attribute bytes of a facet
/// hold its own colour, red in the lowest five bits, if bit 15 is 0, else the facet has the
/// header's colour. VisCAM and SolidView: they hold a colour, blue in the lowest five bits, if bit
/// 15 is 1.
struct StlColours {
  std::vector<Eigen::Vector3f> facets;  ///< [0, 1]; white for facets without one; empty: none
  std::size_t uncoloured = 0;           ///< facets without a colour, if others have one
  bool odd_attributes = false;          ///< attribute bytes that neither dialect explains
};

/// @param header      the first 80 bytes of the file
/// @param attributes  the attribute bytes of each facet, as a little-endian number
[[nodiscard]] StlColours stl_colours(std::string_view header,
                                     const std::vector<std::uint16_t>& attributes);

}  // namespace hydroprint::mesh
