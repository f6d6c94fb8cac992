#include "sim/text/font.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <thread>

#include "sim/base/utf8.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::text {
namespace {

const Font& font() { return *Font::standard().value(); }

std::uint32_t glyph_of(std::string_view character) {
  return font().lay_out(character).glyphs.at(0).glyph;
}

double ink(const Coverage& coverage) {
  return std::accumulate(coverage.samples.begin(), coverage.samples.end(), 0.0) / 255;
}

TEST(Font, CapitalAndSmallLettersAreDifferentGlyphs) {
  EXPECT_NE(glyph_of("g"), glyph_of("G"));
  EXPECT_NE(glyph_of("ä"), glyph_of("Ä"));
  EXPECT_TRUE(font().lay_out("Mug 7 - Ärztin GROSS & klein, №3").missing.empty());
}

TEST(Font, AnXIsAsHighAsTheUnitOfLength) {
  const Line line = font().lay_out("x");
  EXPECT_DOUBLE_EQ(line.high.y(), 1);
  EXPECT_DOUBLE_EQ(line.low.y(), 0);
  EXPECT_NEAR(font().x_height_em(), 0.547, 0.01);
}

TEST(Font, WidthsAddUp) {
  const double both = font().lay_out("Wi").width;
  EXPECT_NEAR(both, font().lay_out("W").width + font().lay_out("i").width, 1e-12);
  EXPECT_GT(font().lay_out("W").width, 2 * font().lay_out("i").width);
  EXPECT_EQ(font().lay_out("").width, 0);
  EXPECT_EQ(font().lay_out("Wi").glyphs[1].left, font().lay_out("W").width);
}

TEST(Font, TheBoxOfALineHoldsAccentsAndDescenders) {
  const Line line = font().lay_out("Åg");
  EXPECT_GT(line.high.y(), 1.6);
  EXPECT_LT(line.low.y(), -0.35);
  EXPECT_GE(line.high.x(), line.width);
}

TEST(Font, CharactersThatItLacksAreReplacedAndListedOnce) {
  const Line line = font().lay_out("a漢\U0001F9D9漢b");
  EXPECT_EQ(line.missing, (std::vector<char32_t>{U'漢', U'\U0001F9D9'}));
  ASSERT_EQ(line.glyphs.size(), 5U);
  for (const std::size_t i : {1U, 2U, 3U}) {
    EXPECT_EQ(line.glyphs[i].character, kReplacement);
    EXPECT_EQ(line.glyphs[i].glyph, glyph_of("\uFFFD"));
  }
  EXPECT_GT(line.glyphs[1].glyph, 0U);
}

TEST(Font, MalformedTextIsReplacedAndListed) {
  EXPECT_EQ(font().lay_out("a\xFF\nb").missing, (std::vector<char32_t>{kReplacement}));
}

TEST(Font, GlyphsAreDrawnWhereTheirOriginIs) {
  const Coverage coverage = font().rasterize(glyph_of("x"), {10, 50}, 20);
  EXPECT_EQ(coverage.top, 30);
  EXPECT_EQ(coverage.top + coverage.height, 50);
  EXPECT_GE(coverage.left, 10);
  EXPECT_GT(ink(coverage), 50);
  const Coverage moved = font().rasterize(glyph_of("x"), {-3, -7}, 20);
  EXPECT_EQ(moved.left, coverage.left - 13);
  EXPECT_EQ(moved.top, coverage.top - 57);
  EXPECT_EQ(moved.samples, coverage.samples);
}

TEST(Font, AFractionOfAPixelMovesInkButDoesNotChangeItsAmount) {
  const Coverage whole = font().rasterize(glyph_of("g"), {10, 50}, 20);
  const Coverage moved = font().rasterize(glyph_of("g"), {10.5, 50.25}, 20);
  EXPECT_NE(whole.samples, moved.samples);
  EXPECT_NEAR(ink(moved), ink(whole), 0.02 * ink(whole));
}

TEST(Font, BlanksAndAbsurdSizesHaveNoInk) {
  EXPECT_TRUE(font().rasterize(glyph_of(" "), {0, 0}, 20).samples.empty());
  EXPECT_TRUE(font().rasterize(glyph_of("x"), {0, 0}, 1e9).samples.empty());
  EXPECT_TRUE(font().rasterize(glyph_of("x"), {NAN, 0}, 20).samples.empty());
  EXPECT_TRUE(font().rasterize(glyph_of("x"), {0, 1e12}, 20).samples.empty());
  EXPECT_TRUE(font().rasterize(99999999, {0, 0}, 20).samples.empty());
}

TEST(Font, ThreadsDrawTheSamePixels) {
  const Coverage alone = font().rasterize(glyph_of("Ä"), {0.3, 0.7}, 31);
  std::vector<Coverage> drawn(4);
  std::vector<std::thread> threads;
  for (Coverage& each : drawn) {
    threads.emplace_back([&each] {
      for (int i = 0; i < 200; ++i) {
        (void)font().rasterize(glyph_of("q"), {0, 0}, 17);
        each = font().rasterize(glyph_of("Ä"), {0.3, 0.7}, 31);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const Coverage& each : drawn) EXPECT_EQ(each.samples, alone.samples);
}

TEST(Font, LongTextIsShortenedWithAnEllipsis) {
  const std::string text = "Mug 7 - Ärztin GROSS & klein";
  const double width = font().lay_out(text).width;
  EXPECT_EQ(font().shortened(text, width), text);
  for (const double part : {0.9, 0.5, 0.2}) {
    const std::string shortened = font().shortened(text, part * width);
    ASSERT_TRUE(shortened.ends_with("…")) << shortened;
    EXPECT_TRUE(text.starts_with(shortened.substr(0, shortened.size() - 3))) << shortened;
    EXPECT_LE(font().lay_out(shortened).width, part * width + 1e-9);
    EXPECT_GT(font().lay_out(shortened).width, part * width - 3.5);
  }
  EXPECT_EQ(font().shortened("Mug WWW", font().lay_out("Mug …").width + 0.1), "Mug…");
  EXPECT_EQ(font().shortened(text, 0.1), "");
  EXPECT_EQ(font().shortened("", 0), "");
}

TEST(Font, AnyBytesCanBeLaidOutAndShortened) {
  std::mt19937 random(3);
  for (int i = 0; i < 500; ++i) {
    std::string bytes(random() % 100, '\0');
    for (char& c : bytes) c = static_cast<char>(random());
    const Line line = font().lay_out(bytes);
    ASSERT_EQ(line.glyphs.size(), decode_utf8(bytes).size());
    ASSERT_TRUE(std::isfinite(line.width));
    ASSERT_LE(font().lay_out(font().shortened(bytes, 20)).width, 20 + 1e-9);
  }
}

TEST(Font, AMissingOrBrokenFileIsNamedWithItsPackage) {
  const testing::TemporaryFolder folder;
  std::string cut = font().file().substr(0, 2000);
  for (const auto& file : {folder.path() / "none.ttf", folder.write("empty.ttf", ""), folder.path(),
                           folder.write("text.ttf", "not a font"), folder.write("cut.ttf", cut)}) {
    const auto opened = Font::open(file);
    ASSERT_FALSE(opened) << file;
    EXPECT_EQ(opened.error().code, Code::kInternal);
    EXPECT_NE(opened.error().message.find(file), std::string::npos) << opened.error().message;
    EXPECT_NE(opened.error().message.find("fonts-dejavu-core"), std::string::npos);
    EXPECT_EQ(opened.error().message.find('\n'), std::string::npos);
  }
}

TEST(Font, ADamagedFileNeverCrashes) {
  const testing::TemporaryFolder folder;
  std::mt19937 random(11);
  for (int i = 0; i < 60; ++i) {
    std::string bytes = font().file();
    for (int k = 0; k < 200; ++k)
      bytes[random() % (k < 100 ? 4000 : bytes.size())] ^= static_cast<char>(1 << random() % 8);
    const auto opened = Font::open(folder.write("damaged.ttf", bytes));
    if (!opened) continue;
    for (const PlacedGlyph& glyph : opened->lay_out("Mug 7 - Ärztin").glyphs) {
      (void)opened->rasterize(glyph.glyph, {0, 0}, 20);
    }
    (void)opened->metrics();
  }
}

}  // namespace
}  // namespace hydroprint::text
