#include "sim/text/missing_glyphs.h"

#include <gtest/gtest.h>

namespace hydroprint::text {
namespace {

TEST(MissingGlyphs, TheWarningNamesCharactersAndPlace) {
  const Warning warning = missing_glyphs_warning({U'漢', U'\U0001F9D9'}, {OnSheet{1}});
  EXPECT_EQ(warning.code, WarningCode::TEXT_GLYPH_MISSING);
  EXPECT_EQ(words_of(warning.where), "sheet 1");
  EXPECT_NE(warning.message.find("'漢' (U+6F22), '\U0001F9D9' (U+1F9D9)"), std::string::npos)
      << warning.message;
}

TEST(MissingGlyphs, WhatWouldConfuseATerminalIsNamedByNumberOnly) {
  const Warning warning = missing_glyphs_warning({0x202E, 0xFE0F, 0xFFFD}, {OnSheet{1}});
  EXPECT_NE(warning.message.find(" U+202E, U+FE0F, malformed UTF-8"), std::string::npos)
      << warning.message;
  EXPECT_EQ(warning.message.find("\u202E"), std::string::npos);
}

TEST(MissingGlyphs, LongListsAreCut) {
  std::vector<char32_t> many;
  for (char32_t c = 0x4E00; c < 0x4E00 + 25; ++c) many.push_back(c);
  const std::string message = missing_glyphs_warning(many, {OnSheet{1}}).message;
  EXPECT_NE(message.find("(U+4E09) and 15 more"), std::string::npos) << message;
}

}  // namespace
}  // namespace hydroprint::text
