#include "sim/base/check.h"

#include <gtest/gtest.h>

namespace hydroprint {
namespace {

TEST(Check, DoesNothingWhileTheConditionHolds) {
  int evaluations = 0;
  HP_CHECK(++evaluations == 1);
  EXPECT_EQ(evaluations, 1);
}

TEST(Check, ABrokenInvariantNamesItsPlaceAndCondition) {
  try {
    const int corners = 2;
    HP_CHECK(corners == 3);
    FAIL() << "no exception";
  } catch (const InvariantError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.rfind("check_test.cpp:", 0), 0U) << message;
    EXPECT_NE(message.find("corners == 3"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace hydroprint
