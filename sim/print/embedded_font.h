#pragma once

#include <map>
#include <string>
#include <vector>

#include "sim/base/result.h"
#include "sim/print/page.h"
#include "sim/text/font.h"

namespace hydroprint::print {

/// The font of a document as embedded in its PDF: a composite font (ISO 32000-1, 9.7) whose
/// character codes (CIDs) number the characters that are drawn. Every character can therefore be
/// copied and searched for, even where several share a glyph.
struct EmbeddedFont {
  const text::Font* font = nullptr;
  std::map<char32_t, unsigned> cids;  ///< 1, 2, ... in the order of the characters
  text::FontMetrics metrics;          ///< its name has the tag of a subset: "ABCDEF+DejaVuSans"
  std::vector<double> widths;         ///< by CID, in thousandths of the em
  std::string file;                   ///< TrueType file with the glyphs of these characters only
  std::string cid_to_gid;             ///< glyph numbers in `file` by CID, two bytes each
  std::string to_unicode;             ///< a CMap: characters by CID

  /// Encodes a line of text as a hexadecimal string of CIDs.
  [[nodiscard]] std::string encoded(const std::string& text) const;
};

/// Prepares the font for the texts of all pages. The same characters yield the same bytes.
/// Returns the errors of text::Font::standard() and text::make_subset().
[[nodiscard]] Result<EmbeddedFont> embed_font(const std::vector<Page>& pages);

}  // namespace hydroprint::print
