#include "sim/base/number_text.h"

#include <gtest/gtest.h>

#include <string>

namespace hydroprint {
namespace {

TEST(NumberText, PeopleGetThreeDigitsOrAllDigitsBeforeThePoint) {
  EXPECT_EQ(three_digits(0), "0");
  EXPECT_EQ(three_digits(0.0123456), "0.0123");
  EXPECT_EQ(three_digits(-12.345), "-12.3");
  EXPECT_EQ(three_digits(99.97), "100");
  EXPECT_EQ(three_digits(23582.34), "23582");
}

TEST(NumberText, SharesAreInPercent) {
  EXPECT_EQ(percent(0), "0 %");
  EXPECT_EQ(percent(0.000034), "0.0034 %");
  EXPECT_EQ(percent(1), "100 %");
}

TEST(NumberText, ShortestTextReadsBackAsTheSameNumber) {
  EXPECT_EQ(shortest_text(0.1), "0.1");
  EXPECT_EQ(shortest_text(1e5), "1e+05");
  EXPECT_EQ(std::stod(shortest_text(1.0 / 3)), 1.0 / 3);
}

}  // namespace
}  // namespace hydroprint
