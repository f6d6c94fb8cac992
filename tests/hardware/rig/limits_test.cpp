#include "hardware/rig/limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/hardware/rig/axis.h"
#include "tests/support/paths.h"

namespace hydroprint::rig {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Limits, TheStoppingDistanceMatchesTheNotes) {
  // At 20 mm/s: 15 mm within 0.25 s + 0.5 s, 1 mm of braking at 200 mm/s^2, and the slack.
  RigConfig config = test_config();
  config.slack_mm = 3;
  EXPECT_NEAR(stopping_distance_mm(config, test_profile(), 20), 15 + 1 + 3, 1e-12);
  EXPECT_NEAR(stopping_distance_mm(config, test_profile(), -20), 15 + 1 + 3, 1e-12);
  EXPECT_NEAR(stopping_distance_mm(config, test_profile(), 0), 3, 1e-12);
}

TEST(Limits, TheStoppingDistanceMatchesASimulatedBraking) {
  const RigConfig config = test_config();
  const drive::DriveProfile profile = test_profile();
  const double v0 = config.max_speed_mm_per_s, dt_s = 1e-5;
  double x_mm = 0, v = v0, t_s = 0;
  while (v > 0) {
    t_s += dt_s;
    x_mm += v * dt_s;
    if (t_s > kStale_s + profile.watchdog->largest_time_s) {
      v -= profile.stopping_deceleration_mm_per_s2 * dt_s;
    }
  }
  EXPECT_NEAR(stopping_distance_mm(config, profile, v0), x_mm + config.slack_mm, 1e-3);
  EXPECT_NEAR(stopping_time_s(config, profile), t_s, 1e-4);
}

TEST(Config, AKeepOutShorterThanTheStoppingDistanceIsRefusedWithTheRequiredValue) {
  RigConfig config = test_config();
  config.max_speed_mm_per_s = 20;
  config.keep_out_mm = 17;  // exactly v T + v^2 / 2a + slack: 15 + 1 + 1 mm
  EXPECT_TRUE(check(config, test_profile()));
  config.keep_out_mm = 16.99;
  const Status refused = check(config, test_profile());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, ErrorReason::CONFIG_INVALID);
  EXPECT_NE(refused.error().message.find("rig.keep_out_mm is 16.99; it must be at least 17"),
            std::string::npos)
      << refused.error().message;
}

TEST(Config, TheDefaultsAreValidForTheShippedVirtualDrive) {
  const auto profile = drive::read_drive_profile(testing::drive_profile_path("virtual"));
  ASSERT_TRUE(profile) << profile.error().message;
  const Status sound = check(RigConfig{}, *profile);
  EXPECT_TRUE(sound) << sound.error().message;
}

TEST(Config, EveryValueOutOfRangeIsRefusedByName) {
  struct Case {
    std::string key;
    double RigConfig::*member;
  };
  const std::vector<Case> cases = {{"end_low_mm", &RigConfig::end_low_mm},
                                   {"end_high_mm", &RigConfig::end_high_mm},
                                   {"keep_out_mm", &RigConfig::keep_out_mm},
                                   {"max_speed_mm_per_s", &RigConfig::max_speed_mm_per_s},
                                   {"slack_mm", &RigConfig::slack_mm},
                                   {"poll_period_s", &RigConfig::poll_period_s},
                                   {"following_error_mm", &RigConfig::following_error_mm},
                                   {"following_error_s", &RigConfig::following_error_s},
                                   {"standstill_mm", &RigConfig::standstill_mm},
                                   {"arrival_mm", &RigConfig::arrival_mm},
                                   {"home_timeout_s", &RigConfig::home_timeout_s}};
  for (const Case& c : cases) {
    for (const double bad : {kNaN, kInfinity, -kInfinity, 1e9, -1e9}) {
      RigConfig config = test_config();
      config.*c.member = bad;
      const Status refused = check(config, test_profile());
      ASSERT_FALSE(refused) << c.key << " " << bad;
      EXPECT_EQ(refused.error().message.find("rig." + c.key + " is "), 0U)
          << refused.error().message;
    }
  }
}

TEST(Config, SlowerThan50HzIsRefused) {
  RigConfig config = test_config();
  config.poll_period_s = 0.021;
  EXPECT_FALSE(check(config, test_profile()));
}

TEST(Config, ASpeedAboveTheDrivesLimitIsRefused) {
  RigConfig config = test_config();
  config.max_speed_mm_per_s = 25;
  config.keep_out_mm = 100;
  const Status refused = check(config, test_profile());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("test drive"), std::string::npos);
}

TEST(Config, AHomingSpeedAboveTheRigsLimitIsRefused) {
  drive::DriveProfile profile = test_profile();
  profile.homing_speed_mm_per_s = 12;
  const Status refused = check(test_config(), profile);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("homing speed"), std::string::npos);
  profile.homing_speed_mm_per_s = 10;
  EXPECT_TRUE(check(test_config(), profile));
}

TEST(Config, EndsWithoutSpaceBetweenTheKeepOutsAreRefused) {
  RigConfig config = test_config();
  config.end_high_mm = config.end_low_mm + 2 * config.keep_out_mm;
  EXPECT_FALSE(check(config, test_profile()));
}

TEST(Limits, ATargetIsRefusedExactlyOutsideTheSoftLimits) {
  const RigConfig config = test_config();
  for (const double good : {0.0, 150.0, 300.0}) EXPECT_TRUE(check_target(config, good)) << good;
  for (const double bad : {-1e-9, 300.0000001, kNaN, kInfinity, -kInfinity}) {
    const Status refused = check_target(config, bad);
    ASSERT_FALSE(refused) << bad;
    EXPECT_EQ(refused.error().reason, ErrorReason::LIMIT_EXCEEDED);
    EXPECT_EQ(refused.error().metadata.at("axis"), "position");
    EXPECT_EQ(refused.error().metadata.at("min"), "0");
    EXPECT_EQ(refused.error().metadata.at("max"), "300");
    EXPECT_TRUE(refused.error().metadata.contains("value"));
  }
}

TEST(Limits, ASpeedOutsideItsRangeIsRefused) {
  const RigConfig config = test_config();
  EXPECT_TRUE(check_speed(config, 10));
  EXPECT_TRUE(check_speed(config, 1e-3));
  for (const double bad : {0.0, -1.0, 10.001, kNaN, kInfinity}) {
    EXPECT_FALSE(check_speed(config, bad)) << bad;
  }
}

TEST(Limits, AnAxisOutsideTheLimitsMayOnlyMoveInwards) {
  const RigConfig config = test_config();
  EXPECT_FALSE(outside_limits(config, 0 - config.slack_mm, 10));
  EXPECT_TRUE(outside_limits(config, 0 - config.slack_mm - 0.01, 10));
  EXPECT_TRUE(outside_limits(config, 300 + config.slack_mm + 0.01, 10));
  EXPECT_FALSE(outside_limits(config, -15, -15));
  EXPECT_FALSE(outside_limits(config, -5, -15));
  EXPECT_TRUE(outside_limits(config, -15 - config.slack_mm - 0.01, -15));
  EXPECT_TRUE(outside_limits(config, kNaN, 10));
}

TEST(Limits, AJogMayContinueWhileItCanStillBrakeBeforeTheLimit) {
  const RigConfig config = test_config();  // soft limits at 0 and 300 mm
  const drive::DriveProfile profile = test_profile();
  const double v = 10, looks_mm = v * 3 * config.poll_period_s;
  const double brake_mm = v * v / (2 * profile.stopping_deceleration_mm_per_s2);
  const double ahead_mm = looks_mm + brake_mm;
  EXPECT_TRUE(may_jog(config, profile, 300 - ahead_mm - 0.01, v));
  EXPECT_FALSE(may_jog(config, profile, 300 - ahead_mm + 0.01, v));
  EXPECT_TRUE(may_jog(config, profile, ahead_mm + 0.01, -v));
  EXPECT_FALSE(may_jog(config, profile, ahead_mm - 0.01, -v));
  EXPECT_TRUE(may_jog(config, profile, -15, v)) << "an axis outside the limits may move inwards";
  EXPECT_FALSE(may_jog(config, profile, -15, -v));
}

}  // namespace
}  // namespace hydroprint::rig
