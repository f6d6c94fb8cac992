#include "sim/base/utf8.h"

#include <gtest/gtest.h>

#include <random>

namespace hydroprint {
namespace {

TEST(Utf8, WellFormedTextSurvivesDecodingAndEncoding) {
  const std::string text = "Mug 7 - Ärztin GROSS & klein, №3 漢字 \U0001F98A \U0010FFFD";
  EXPECT_EQ(encode_utf8(decode_utf8(text)), text);
  EXPECT_EQ(decode_utf8("Ä№\U0001F98A"), U"Ä№\U0001F98A");
}

TEST(Utf8, EachMalformedSequenceBecomesOneReplacement) {
  EXPECT_EQ(decode_utf8("\xFF"), U"\uFFFD");
  EXPECT_EQ(decode_utf8("a\x80z"), U"a\uFFFDz");
  EXPECT_EQ(decode_utf8("\xC0\xAF"), U"\uFFFD\uFFFD");                      // overlong
  EXPECT_EQ(decode_utf8("\xE0\x80\xAF"), U"\uFFFD\uFFFD\uFFFD");            // overlong
  EXPECT_EQ(decode_utf8("\xED\xA0\x80"), U"\uFFFD\uFFFD\uFFFD");            // surrogate
  EXPECT_EQ(decode_utf8("\xF4\x90\x80\x80"), U"\uFFFD\uFFFD\uFFFD\uFFFD");  // above U+10FFFF
  EXPECT_EQ(decode_utf8("\xE6\xBC|\xF0\x9F\xA6"), U"\uFFFD|\uFFFD");        // truncated
}

TEST(Utf8, ControlCharactersBecomeReplacements) {
  EXPECT_EQ(decode_utf8(std::string("a\nb\0c\x7F", 6)), U"a\uFFFDb\uFFFDc\uFFFD");
  EXPECT_EQ(decode_utf8("\xC2\x85"), U"\uFFFD");
}

TEST(Utf8, EncodingNeverYieldsMalformedText) {
  EXPECT_EQ(encode_utf8(std::u32string{0xD800, 0x110000}), "\uFFFD\uFFFD");
}

TEST(Utf8, AnyBytesDecodeToTextThatSurvives) {
  std::mt19937 random(7);
  for (int i = 0; i < 20000; ++i) {
    std::string bytes(random() % 12, '\0');
    for (char& c : bytes)
      c = static_cast<char>(random() % 4 == 0 ? random() : 0x80 + random() % 128);
    const std::u32string decoded = decode_utf8(bytes);
    ASSERT_LE(decoded.size(), bytes.size());
    ASSERT_EQ(decode_utf8(encode_utf8(decoded)), decoded);
  }
}

}  // namespace
}  // namespace hydroprint
