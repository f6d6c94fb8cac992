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

TEST(NumberText, SizesHaveOneDecimalAndALargerUnitFromAThousand) {
  EXPECT_EQ(format_bytes(0), "0 B");
  EXPECT_EQ(format_bytes(999), "999 B");
  EXPECT_EQ(format_bytes(1000), "1.0 kB");
  EXPECT_EQ(format_bytes(999'949), "999.9 kB");
  EXPECT_EQ(format_bytes(999'950), "1.0 MB");
  EXPECT_EQ(format_bytes(20'000'000'000), "20.0 GB");
  EXPECT_EQ(format_bytes(5'000'000'000'000'000), "5000.0 TB");
}

TEST(NumberText, DurationsShowHoursOnlyIfThereAreAny) {
  EXPECT_EQ(format_duration(std::chrono::seconds(-3)), "0:00");
  EXPECT_EQ(format_duration(std::chrono::seconds(7)), "0:07");
  EXPECT_EQ(format_duration(std::chrono::seconds(750)), "12:30");
  EXPECT_EQ(format_duration(std::chrono::seconds(3723)), "1:02:03");
}

}  // namespace
}  // namespace hydroprint
