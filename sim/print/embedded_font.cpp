#include "sim/print/embedded_font.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <set>

#include "sim/base/sha256.h"
#include "sim/text/font_subset.h"

namespace hydroprint::print {
namespace {

constexpr std::size_t kMostPerSection = 100;  ///< maximum number of entries in a CMap's section

/// Returns four hexadecimal digits.
std::string hex16(unsigned value) { return fmt::format("{:04X}", value); }

/// Returns a character in UTF-16, big-endian, as hexadecimal digits.
std::string utf16(char32_t c) {
  if (c < 0x10000) return hex16(c);
  const char32_t above = c - 0x10000;
  return hex16(0xD800 | above >> 10) + hex16(0xDC00 | (above & 0x3FF));
}

std::string to_unicode_cmap(const std::map<char32_t, unsigned>& cids) {
  std::string out =
      "/CIDInit /ProcSet findresource begin\n12 dict begin\nbegincmap\n"
      "/CIDSystemInfo << /Registry (Adobe) /Ordering (UCS) /Supplement 0 >> def\n"
      "/CMapName /Adobe-Identity-UCS def\n/CMapType 2 def\n"
      "1 begincodespacerange\n<0000> <FFFF>\nendcodespacerange\n";
  std::size_t left = cids.size(), in_section = 0;
  for (const auto& [character, cid] : cids) {
    if (in_section == 0) {
      in_section = std::min(left, kMostPerSection);
      out += fmt::format("{} beginbfchar\n", in_section);
    }
    out += fmt::format("<{}> <{}>\n", hex16(cid), utf16(character));
    --left;
    if (--in_section == 0) out += "endbfchar\n";
  }
  return out + "endcmap\nCMapName currentdict /CMap defineresource pop\nend\nend\n";
}

/// Returns the name of a subset: six capital letters derived from its content, and the font's name.
std::string subset_name(const std::string& font_name, const std::string& file) {
  const std::string digest = sha256(file);
  std::string out;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto value = std::stoul(digest.substr(4 * i, 4), nullptr, 16);
    out += static_cast<char>('A' + value % 26);
  }
  out += '+';
  for (const char c : font_name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-') out += c;
  }
  return out;
}

void append16(std::string& out, unsigned value) {
  out += static_cast<char>(value >> 8);
  out += static_cast<char>(value & 0xFF);
}

}  // namespace

std::string EmbeddedFont::encoded(const std::string& text) const {
  std::string out = "<";
  for (const text::PlacedGlyph& glyph : font->lay_out(text).glyphs) {
    out += hex16(cids.at(glyph.character));
  }
  return out + ">";
}

Result<EmbeddedFont> embed_font(const std::vector<Page>& pages) {
  EmbeddedFont out;
  HP_ASSIGN_OR_RETURN(out.font, text::Font::standard());
  std::map<char32_t, std::uint32_t> characters;
  std::set<std::uint32_t> glyphs = {0};
  for (const Page& page : pages) {
    for (const Text& text : page.texts) {
      for (const text::PlacedGlyph& glyph : out.font->lay_out(text.text).glyphs) {
        characters[glyph.character] = glyph.glyph;
        glyphs.insert(glyph.glyph);
      }
    }
  }
  HP_ASSIGN_OR_RETURN(const text::FontSubset subset, text::make_subset(*out.font, glyphs));
  out.widths.push_back(1000 * out.font->advance_em(0));
  append16(out.cid_to_gid, 0);
  for (const auto& [character, glyph] : characters) {
    out.cids[character] = static_cast<unsigned>(out.widths.size());
    out.widths.push_back(1000 * out.font->advance_em(glyph));
    append16(out.cid_to_gid, subset.glyphs.at(glyph));
  }
  out.to_unicode = to_unicode_cmap(out.cids);
  out.metrics = out.font->metrics();
  out.metrics.name = subset_name(out.metrics.name, subset.file);
  out.file = subset.file;
  return out;
}

}  // namespace hydroprint::print
