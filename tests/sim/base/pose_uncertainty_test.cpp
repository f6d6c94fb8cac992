#include "sim/base/pose_uncertainty.h"

#include <gtest/gtest.h>

namespace hydroprint {
namespace {

TEST(PoseUncertainty, APoseWithoutAStatedOrWithASmallErrorIsNotDoubted) {
  EXPECT_TRUE(pose_warnings({}, {OfItem{"pose"}}).empty());
  EXPECT_TRUE(pose_warnings({1.0, {}}, {OfItem{"pose"}}).empty());
}

TEST(PoseUncertainty, ALargeErrorIsNamedWithItsRemedy) {
  const Warnings warnings = pose_warnings({1.26, {}}, {OfResource{"calibrations/3"}});
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].code, WarningCode::POSE_UNCERTAIN);
  EXPECT_EQ(words_of(warnings[0].where), "calibrations/3");
  EXPECT_NE(warnings[0].message.find("1.3 mm"), std::string::npos) << warnings[0].message;
  EXPECT_NE(warnings[0].message.find("calibrate again"), std::string::npos);
}

/// A nominal pose makes the error large, so a second warning would say the same.
TEST(PoseUncertainty, EachMotionFromTheNominalPoseIsOneWarning) {
  const Warnings warnings =
      pose_warnings({10, {"shift along x", "shift along y"}}, {OfItem{"pose"}});
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[1].code, WarningCode::POSE_UNCONSTRAINED);
  EXPECT_NE(warnings[1].message.find("shift along y"), std::string::npos);
  EXPECT_NE(warnings[1].message.find("calibrate again"), std::string::npos);
}

}  // namespace
}  // namespace hydroprint
