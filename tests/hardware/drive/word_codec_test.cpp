#include "hardware/drive/word_codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/campaign.h"

namespace hydroprint::drive {
namespace {

using Words = std::vector<std::uint16_t>;

Words encoded(const Format& format, double value) {
  const auto words = encode(format, value);
  EXPECT_TRUE(words) << words.error().message;
  return words.value_or(Words{});
}

TEST(Codec, WordsMatchAManual) {
  EXPECT_EQ(encoded({1, false, false, 10, false}, 20), Words({200}));
  EXPECT_EQ(encoded({1, true, false, 1, false}, -2), Words({0xfffe}));
  EXPECT_EQ(encoded({2, true, false, 10000, false}, 12.3456), Words({0x0001, 0xe240}));
  EXPECT_EQ(encoded({2, true, true, 10000, false}, 12.3456), Words({0xe240, 0x0001}));
  EXPECT_EQ(encoded({2, true, false, 10000, false}, -0.0001), Words({0xffff, 0xffff}));
  EXPECT_EQ(encoded({2, true, false, -1000, false}, 1), Words({0xffff, 0xfc18}));
}

TEST(Codec, ARampGivenAsATimeIsTheInverse) {
  const Format format{1, false, false, 83333, true};
  EXPECT_EQ(encoded(format, 200), Words({417}));
  EXPECT_NEAR(decode(format, Words{417}), 199.84, 0.01);
}

TEST(Codec, DecodingReversesEncodingWithinHalfACount) {
  std::mt19937 random(testing::campaign_seed(7));
  for (const bool is_signed : {false, true}) {
    for (const int words : {1, 2}) {
      for (const bool low_first : {false, true}) {
        const Format format{words, is_signed, low_first, 12.5, false};
        const double most = (std::exp2(16 * words - (is_signed ? 1 : 0)) - 1) / 12.5;
        std::uniform_real_distribution<double> value(is_signed ? -most : 0, most);
        for (int i = 0; i < testing::campaign_rounds(200); ++i) {
          const double x = value(random);
          const auto raw = encode(format, x);
          ASSERT_TRUE(raw || std::abs(x) < 0.5 / 12.5);
          if (raw) {
            EXPECT_NEAR(decode(format, *raw), x, 0.5 / 12.5 + 1e-9 * most);
          }
        }
      }
    }
  }
}

TEST(Codec, ValuesThatDoNotFitTheRegistersAreRefused) {
  const std::vector<std::pair<Format, double>> cases = {
      {{1, false, false, 1, false}, 65536}, {{1, false, false, 1, false}, -1},
      {{1, true, false, 1, false}, 32768},  {{2, true, false, 1e6, false}, 3000},
      {{1, false, false, 1, false}, 0.4},   {{1, false, false, 1000, true}, 0},
      {{2, true, false, 1, false}, NAN},    {{2, false, false, 1, false}, INFINITY}};
  for (const auto& [format, value] : cases) {
    const auto words = encode(format, value);
    ASSERT_FALSE(words) << value;
    EXPECT_EQ(words.error().reason, ErrorReason::LIMIT_EXCEEDED);
    EXPECT_EQ(words.error().code, Code::kOutOfRange);
  }
}

}  // namespace
}  // namespace hydroprint::drive
