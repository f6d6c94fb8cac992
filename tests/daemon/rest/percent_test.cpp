#include "daemon/rest/percent.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>

namespace hydroprint::rest {
namespace {

std::string utf8(std::uint32_t point) {
  const auto byte = [](std::uint32_t value) { return static_cast<char>(value); };
  if (point < 0x80) return {byte(point)};
  if (point < 0x800) return {byte(0xc0 | point >> 6), byte(0x80 | (point & 63))};
  if (point < 0x10000) {
    return {byte(0xe0 | point >> 12), byte(0x80 | (point >> 6 & 63)), byte(0x80 | (point & 63))};
  }
  return {byte(0xf0 | point >> 18), byte(0x80 | (point >> 12 & 63)), byte(0x80 | (point >> 6 & 63)),
          byte(0x80 | (point & 63))};
}

TEST(Percent, AllCodePointsExceptSurrogatesAreValidUtf8) {
  for (std::uint32_t point = 0; point <= 0x10ffff; ++point) {
    const bool is_surrogate = point >= 0xd800 && point <= 0xdfff;
    ASSERT_EQ(not_utf8_at(utf8(point)) != std::string::npos, is_surrogate) << point;
  }
}

// Number of bytes of the character at that place; 0 if it is not valid UTF-8. A character is valid
// if encoding its code point gives the same bytes.
std::size_t length_at(const std::string& bytes, std::size_t at) {
  for (std::size_t length = 1; length <= 4 && at + length <= bytes.size(); ++length) {
    const std::string part = bytes.substr(at, length);
    const auto first = static_cast<std::uint8_t>(part[0]);
    std::uint32_t point = length == 1 ? first : first & (0x7fU >> length);
    for (std::size_t i = 1; i < length; ++i) {
      point = point << 6 | (static_cast<std::uint8_t>(part[i]) & 63);
    }
    const bool is_point = point <= 0x10ffff && (point < 0xd800 || point > 0xdfff);
    if (is_point && utf8(point) == part) return length;
  }
  return 0;
}

bool is_utf8(const std::string& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t length = length_at(bytes, at);
    if (length == 0) return false;
    at += length;
  }
  return true;
}

TEST(Percent, OnlyEncodedCodePointsAreValidUtf8) {
  std::mt19937 random(3);
  std::size_t good = 0;
  for (std::uint32_t i = 0; i < 0x10000 + 200000; ++i) {
    std::string bytes = {static_cast<char>(i >> 8), static_cast<char>(i)};
    if (i >= 0x10000) {
      static constexpr std::array<std::uint8_t, 8> kLeads = {0xe0, 0xe1, 0xed, 0xef,
                                                             0xf0, 0xf3, 0xf4, 0xf5};
      bytes = {static_cast<char>(kLeads[random() % 8])};
      for (std::size_t k = 2 + random() % 2; k > 0; --k) {
        bytes += static_cast<char>(0x70 + random() % 0x60);
      }
    }
    ASSERT_EQ(not_utf8_at(bytes) == std::string::npos, is_utf8(bytes)) << i;
    good += is_utf8(bytes) ? 1 : 0;
  }
  EXPECT_GT(good, 20000U);
}

TEST(Percent, DecodesWhatItEncodes) {
  for (int byte = 1; byte < 0x80; ++byte) {
    const std::string text(1, static_cast<char>(byte));
    EXPECT_EQ(decode(encode(text)), text);
    EXPECT_EQ(decode_query(encode(text)), text);
  }
  EXPECT_EQ(encode("aZ09-_.~"), "aZ09-_.~");
  EXPECT_EQ(encode("é/ "), "%C3%A9%2F%20");
}

TEST(Percent, PlusIsASpaceOnlyInQueries) {
  EXPECT_EQ(decode("a+b"), "a+b");
  EXPECT_EQ(decode_query("a+b%2B"), "a b+");
}

TEST(Percent, ErrorNamesTheByte) {
  EXPECT_EQ(decode("ab%4x").error().message,
            "\"ab%4x\", byte 2: % must be followed by two hex digits");
}

TEST(Percent, UntrustedTextIsSanitised) {
  EXPECT_EQ(plain("a\n\"é\\"), "a?????");
  EXPECT_EQ(plain(std::string(200, 'a')), std::string(100, 'a') + "...");
}

}  // namespace
}  // namespace hydroprint::rest
