#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "sim/base/result.h"
#include "sim/text/font.h"

namespace hydroprint::text {

/// A font that contains a few glyphs of another font.
struct FontSubset {
  std::string file;  ///< TrueType, without instructions for hinting
  /// Index of each glyph in `file`, keyed by its index in the original font.
  std::map<std::uint32_t, std::uint32_t> glyphs;
};

/// Reduces a font to the given glyphs and their components. The same glyphs yield the same bytes.
/// Returns kInternal if HarfBuzz fails.
[[nodiscard]] Result<FontSubset> make_subset(const Font& font,
                                             const std::set<std::uint32_t>& glyphs);

}  // namespace hydroprint::text
