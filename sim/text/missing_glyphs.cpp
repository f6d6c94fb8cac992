#include "sim/text/missing_glyphs.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/base/check.h"
#include "sim/base/utf8.h"

namespace hydroprint::text {
namespace {

constexpr std::size_t kMostNames = 10;

/// Returns true for characters that would change how a terminal shows the message.
bool is_invisible(char32_t c) {
  return (c >= 0x200B && c <= 0x200F) || (c >= 0x2028 && c <= 0x202E) ||
         (c >= 0x2060 && c <= 0x206F) || (c >= 0xFE00 && c <= 0xFE0F) || c == 0xFEFF ||
         (c >= 0xE0000 && c <= 0xE0FFF);
}

/// "'漢' (U+6F22)"
std::string name_of(char32_t c) {
  if (c == kReplacement) return "malformed UTF-8 or control characters";
  const std::string number = fmt::format("U+{:04X}", static_cast<unsigned>(c));
  return is_invisible(c) ? number : fmt::format("'{}' ({})", encode_utf8({&c, 1}), number);
}

}  // namespace

Warning missing_glyphs_warning(const std::vector<char32_t>& characters, const Place& where) {
  HP_CHECK(!characters.empty());
  std::string names;
  for (std::size_t i = 0; i < std::min(kMostNames, characters.size()); ++i) {
    if (i > 0) names += ", ";
    names += name_of(characters[i]);
  }
  if (characters.size() > kMostNames) {
    names += fmt::format(" and {} more", characters.size() - kMostNames);
  }
  return {WarningCode::TEXT_GLYPH_MISSING,
          fmt::format("the font cannot draw {}; the replacement character (U+FFFD) is drawn "
                      "instead. Use other characters",
                      names),
          where};
}

}  // namespace hydroprint::text
