#include "sim/base/number_text.h"

#include <gtest/gtest.h>

namespace hydroprint {
namespace {

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
