#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "sim/base/result.h"
#include "sim/text/font.h"

namespace hydroprint::text {

/// A font that holds a few glyphs of another.
struct FontSubset {
  std::string file;                               ///< TrueType, without instructions for hinting
  std::map<std::uint32_t, std::uint32_t> glyphs;  ///< numbers of its glyphs by those of the whole
};

/// Reduces a font to the given glyphs and those that they are composed of. The same glyphs give the
/// same bytes. Fails (kInternal) if HarfBuzz cannot do it.
[[nodiscard]] Result<FontSubset> make_subset(const Font& font,
                                             const std::set<std::uint32_t>& glyphs);

}  // namespace hydroprint::text
