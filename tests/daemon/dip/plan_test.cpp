#include "daemon/dip/plan.h"

#include <gtest/gtest.h>

#include "daemon/dip/operator_messages.h"
#include "tests/support/paths.h"

namespace hydroprint::dip {
namespace {

const rig::RigConfig kConfig;  // soft limits 2 and 298 mm, at most 10 mm/s

drive::DriveProfile profile() {
  return drive::read_drive_profile(testing::drive_profile_path("virtual")).value();
}

Plan plan_of_depth(double depth_mm) {
  Plan plan;
  plan.depth_mm = depth_mm;
  return plan;
}

std::string refusal(const Plan& plan, double contact_mm) {
  const auto ways = ways_from(plan, contact_mm, 5, kConfig, profile());
  if (ways) return "";
  EXPECT_EQ(ways.error().code, Code::kOutOfRange);
  EXPECT_TRUE(ways.error().metadata.contains("value"));
  return std::string(name_of(ways.error().reason));
}

TEST(DipPlan, DescendsFromClearanceToDepthAndReturns) {
  const Plan plan = plan_of_depth(30);
  const auto ways = ways_from(plan, 100, 5, kConfig, profile());
  ASSERT_TRUE(ways) << ways.error().message;
  EXPECT_EQ(ways->clear_mm, 80);
  EXPECT_EQ(ways->bottom_mm, 130);
  EXPECT_EQ(ways->up_mm, 5);
  const auto way = legs(plan, *ways);
  ASSERT_EQ(way.size(), 2U);
  EXPECT_EQ(way[0].target_mm, 130);
  EXPECT_EQ(way[0].hold_s, 2);
  EXPECT_EQ(way[1].target_mm, 5);
}

TEST(DipPlan, RetractionEndsAboveTheWater) {
  EXPECT_EQ(ways_from(plan_of_depth(30), 100, 99, kConfig, profile())->up_mm, 80);
  EXPECT_EQ(ways_from(plan_of_depth(30), 100, -1, kConfig, profile())->up_mm, 2)
      << "an axis that rests outside its limits is not sent back there";
}

TEST(DipPlan, ClearanceShrinksNearTheLimit) {
  EXPECT_EQ(ways_from(plan_of_depth(30), 12, 5, kConfig, profile())->clear_mm, 2);
}

TEST(DipPlan, TargetsOutOfReachAreRefused) {
  EXPECT_EQ(refusal(plan_of_depth(198), 100), "");
  EXPECT_EQ(refusal(plan_of_depth(198.1), 100), "LIMIT_EXCEEDED");
  EXPECT_EQ(refusal(plan_of_depth(10), 3), "");
  EXPECT_EQ(refusal(plan_of_depth(10), 2.9), "LIMIT_EXCEEDED")
      << "less than 1 mm of way to accelerate";
  EXPECT_EQ(refusal(plan_of_depth(10), -0.1), "LIMIT_EXCEEDED");
  Plan deep = plan_of_depth(296);
  EXPECT_FALSE(check(deep, kConfig));
  deep.depth_mm = 295;
  EXPECT_TRUE(check(deep, kConfig));
  deep.speed_mm_per_s = 10.1;
  EXPECT_FALSE(check(deep, kConfig));
}

TEST(DipPlan, ProgressGrowsFromZeroToOneAndNeverFalls) {
  const Plan plan = plan_of_depth(20);
  const Ways ways{80, 120, 5};
  double before = -1;
  for (int i = 1; i <= kSteps; ++i) {
    Stand stand;
    stand.step = static_cast<Step>(i);
    stand.since_s = 100;
    for (const double elapsed_s : {0.0, 1.0, 1000.0}) {
      const ProgressEstimate now = estimate_progress(stand, 100 + elapsed_s, plan, ways, 200);
      EXPECT_GE(now.fraction, before) << name(stand.step);
      EXPECT_LE(now.fraction, 1);
      before = now.fraction;
    }
  }
  EXPECT_DOUBLE_EQ(before, 1);
  // 20 mm up, 60 s of soaking, 20 s of activation, 40 mm down, 2 s at depth, 115 mm up; at 5 mm/s
  // and 200 mm/s^2.
  const ProgressEstimate begin = estimate_progress({}, 0, plan, ways, 200);
  EXPECT_EQ(begin.fraction, 0);
  EXPECT_NEAR(begin.remaining_s, 4 + 60 + 20 + 8 + 2 + 23, 0.2);
}

TEST(DipPlan, ActivatorIsProportionalToTheFilmArea) {
  const Plan plan;  // the default: an A4 film and 16 ml/m2
  EXPECT_NEAR(plan.activator_ml(), 0.998, 0.001);
  EXPECT_NE(instruction(Step::kSprayActivator, plan).find("1.0 ml"), std::string::npos);
}

TEST(DipPlan, DipOfAPlanNamesWhatComesNext) {
  Plan plan;
  EXPECT_EQ(afterwards(plan).find("the plan"), std::string::npos);
  plan.immersion = 2;
  plan.immersions = 3;
  plan.plan_job = "jobs/7";
  EXPECT_EQ(afterwards(plan),
            "skim the rest of the film off the water, take the object out, rinse it and let it "
            "dry; the plan jobs/7 states what comes next");
}

TEST(DipPlan, EveryStepHasAnInstructionAndAdvice) {
  for (int i = 1; i <= kSteps; ++i) {
    EXPECT_FALSE(instruction(static_cast<Step>(i), Plan()).empty());
    const std::string words = advice(static_cast<Step>(i));
    EXPECT_NE(words.find("film"), std::string::npos) << words;
  }
}

}  // namespace
}  // namespace hydroprint::dip
