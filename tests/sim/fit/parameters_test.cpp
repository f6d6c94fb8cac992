#include "sim/fit/parameters.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hydroprint::fit {
namespace {

TEST(Parameters, ScaledValuesReadBackAsTheyWereSet) {
  film::Profile profile;
  profile.thickness_mm = 0.04;
  for (const Parameter parameter : kAllParameters) {
    for (const double scaled : {0.0, 0.1, 0.5, 1.0}) {
      set_scaled(parameter, scaled, profile);
      EXPECT_NEAR(scaled_value(parameter, profile), scaled, 1e-12)
          << describe(parameter, profile).name;
    }
  }
}

TEST(Parameters, NoDragIsZeroAndItsLengthIsInfinite) {
  film::Profile profile;
  EXPECT_EQ(scaled_value(Parameter::kDrag, profile), 0);
  EXPECT_TRUE(std::isinf(natural_value(Parameter::kDrag, 0, profile)));
  profile.drag_length_mm = 20;
  EXPECT_NEAR(natural_value(Parameter::kDrag, scaled_value(Parameter::kDrag, profile), profile), 20,
              1e-12);
  set_scaled(Parameter::kDrag, 0, profile);
  EXPECT_EQ(profile.drag_length_mm, 0) << "profiles write an infinite drag length as 0";
}

TEST(Parameters, BoundsStayWithinTheLimitsOfProfiles) {
  film::Profile profile;
  profile.thickness_mm = 0.7;
  for (const Parameter parameter : kAllParameters) {
    const Description what = describe(parameter, profile);
    for (const double bound : {what.least, what.most}) {
      set_scaled(parameter, bound, profile);
      EXPECT_GE(profile.swelling.minCoeff(), 1);
      EXPECT_LE(profile.swelling.maxCoeff(), 2);
      EXPECT_GE(profile.ink_ratio_mm, 0);
      EXPECT_LE(profile.ink_ratio_mm, 10);
      EXPECT_LE(profile.drag_length_mm, 1e4);
    }
  }
}

TEST(Parameters, NamesMatchTheCommandLine) {
  EXPECT_EQ(parse_parameters({})->size(), 4u);
  EXPECT_EQ(
      parse_parameters({"swelling", "drag", "drag"}).value(),
      (std::vector<Parameter>{Parameter::kDrag, Parameter::kSwellingX, Parameter::kSwellingY}));
  const auto bad = parse_parameters({"drag", "young_modulus"});
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().message,
            "'young_modulus' cannot be fitted. Use ink_ratio, drag or swelling");
}

}  // namespace
}  // namespace hydroprint::fit
