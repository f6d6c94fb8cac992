#include "sim/base/checked_json.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hydroprint {
namespace {

std::string refusal(std::string_view text, JsonLimits limits = {}) {
  const auto read = parse_json(text, limits);
  return read ? "" : read.error().message;
}

TEST(CheckedJson, AnErrorNamesLineAndColumn) {
  EXPECT_NE(refusal("{\n  \"a\": ,\n}").find("line 2, column 8: not valid JSON"), std::string::npos)
      << refusal("{\n  \"a\": ,\n}");
  EXPECT_NE(refusal("").find("line 1"), std::string::npos);
}

TEST(CheckedJson, NumbersBeyondTheRangeOfDoubleAreRefused) {
  EXPECT_NE(refusal("[1e999]").find("number that is too large"), std::string::npos);
}

TEST(CheckedJson, LengthAndDepthAreLimited) {
  EXPECT_EQ(refusal("[1,2]", {5, 1}), "");
  EXPECT_NE(refusal("[1,2] ", {5, 1}).find("longer than 5 bytes"), std::string::npos);
  EXPECT_EQ(refusal("[[],{}]", {100, 2}), "");
  EXPECT_NE(refusal("[[[]]]", {100, 2}).find("deeper than 2 levels"), std::string::npos);
  EXPECT_NE(refusal(std::string(1 << 20, '[')).find("deeper"), std::string::npos);
}

TEST(CheckedJson, BracketsInStringsDoNotCountAsDepth) {
  EXPECT_EQ(refusal(R"(["[[[[", "\"[[[["])", {100, 1}), "");
}

TEST(CheckedJson, FieldsAreReadOnlyIfTheirTypeFits) {
  const auto object = nlohmann::json::parse(R"({"x": 1.5, "n": 3, "minus": -3, "word": "w"})");
  EXPECT_EQ(json_number(object, "x"), 1.5);
  EXPECT_EQ(json_number(object, "word"), std::nullopt);
  EXPECT_EQ(json_unsigned(object, "n"), 3U);
  EXPECT_EQ(json_unsigned(object, "minus"), std::nullopt);
  EXPECT_EQ(json_unsigned(object, "x"), std::nullopt);
  EXPECT_EQ(json_string(object, "word"), "w");
  EXPECT_EQ(json_string(object, "missing"), std::nullopt);
  EXPECT_EQ(json_string(nlohmann::json::array(), "word"), std::nullopt);
  EXPECT_EQ(json_number({{"x", std::nan("")}}, "x"), std::nullopt);
  EXPECT_EQ(json_at(object, "n"), 3);
  EXPECT_TRUE(json_at(object, "missing").is_null());
  EXPECT_TRUE(json_at(json_at(object, "missing"), "deeper").is_null());
}

}  // namespace
}  // namespace hydroprint
