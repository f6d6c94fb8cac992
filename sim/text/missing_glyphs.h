#pragma once

#include <string>
#include <vector>

#include "sim/base/result.h"

namespace hydroprint::text {

/// Returns the warning `TEXT_GLYPH_MISSING`, which names the characters that are drawn as U+FFFD.
/// @param characters  Line::missing, not empty
/// @param where       location of the text, for the report
[[nodiscard]] Warning missing_glyphs_warning(const std::vector<char32_t>& characters,
                                             const Place& where);

}  // namespace hydroprint::text
