#include "sim/text/font_subset.h"

#include <ft2build.h>
#include <gtest/gtest.h>
#include FT_FREETYPE_H

#include <array>
#include <random>

#include "tests/support/temporary_folder.h"

namespace hydroprint::text {
namespace {

const Font& font() { return *Font::standard().value(); }

std::set<std::uint32_t> glyphs_of(std::string_view text) {
  std::set<std::uint32_t> out = {0};
  for (const PlacedGlyph& glyph : font().lay_out(text).glyphs) out.insert(glyph.glyph);
  return out;
}

/// Width, height, advance and number of points of a glyph.
std::array<long, 4> shape_of(const std::string& file, std::uint32_t glyph) {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  EXPECT_EQ(FT_Init_FreeType(&library), 0);
  EXPECT_EQ(FT_New_Memory_Face(library, reinterpret_cast<const FT_Byte*>(file.data()),
                               static_cast<FT_Long>(file.size()), 0, &face),
            0);
  EXPECT_EQ(FT_Load_Glyph(face, glyph, FT_LOAD_NO_SCALE), 0);
  const FT_GlyphSlot slot = face->glyph;
  const std::array<long, 4> out = {slot->metrics.width, slot->metrics.height,
                                   slot->metrics.horiAdvance, slot->outline.n_points};
  FT_Done_Face(face);
  FT_Done_FreeType(library);
  return out;
}

TEST(FontSubset, HoldsTheSameShapesInAFractionOfTheBytes) {
  const auto glyphs = glyphs_of("Mug 7 - Ärztin GROSS & klein, №3");
  const FontSubset subset = make_subset(font(), glyphs).value();
  EXPECT_LT(subset.file.size(), 20000U);
  EXPECT_GT(font().file().size(), 500000U);
  ASSERT_EQ(subset.glyphs.size(), glyphs.size());
  for (const auto& [old_glyph, new_glyph] : subset.glyphs) {
    EXPECT_EQ(shape_of(font().file(), old_glyph), shape_of(subset.file, new_glyph)) << old_glyph;
  }
}

TEST(FontSubset, SameGlyphsGiveSameBytes) {
  const auto glyphs = glyphs_of("Mug 7");
  EXPECT_EQ(make_subset(font(), glyphs)->file, make_subset(font(), glyphs)->file);
  EXPECT_NE(make_subset(font(), glyphs)->file, make_subset(font(), glyphs_of("Mug 8"))->file);
}

TEST(FontSubset, ADamagedFontNeverCrashes) {
  const testing::TemporaryFolder folder;
  std::mt19937 random(13);
  for (int i = 0; i < 30; ++i) {
    std::string bytes = font().file();
    for (int k = 0; k < 100; ++k)
      bytes[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
    const auto opened = Font::open(folder.write("damaged.ttf", bytes));
    if (opened) (void)make_subset(*opened, glyphs_of("Mug 7 - Ärztin"));
  }
}

}  // namespace
}  // namespace hydroprint::text
