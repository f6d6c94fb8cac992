#include "daemon/dip/record.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "sim/base/input_file.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::dip {
namespace {

using nlohmann::json;

rig::Sample sample(double time_s, double position_mm) {
  rig::Sample out;
  out.time = rig::TimePoint(std::chrono::milliseconds(std::lround(1000 * time_s)));
  out.position_mm = position_mm;
  out.velocity_mm_per_s = 5;
  out.expected_mm = position_mm;
  out.motion = 1;
  out.leg = 0;
  out.cruising = true;
  return out;
}

TEST(DipRecord, DepthsAreRelativeToFirstContact) {
  const testing::TemporaryFolder folder;
  PositionLog log(folder.path(), rig::TimePoint());
  rig::Sample unknown = sample(2, 39);
  unknown.expected_mm = std::numeric_limits<double>::quiet_NaN();
  log.add(std::vector{sample(1.5, 45), unknown}, "dip", 40);
  ASSERT_TRUE(log.flush());
  EXPECT_EQ(*read_text_file(folder.path() / "positions.csv", 1000),
            "t_s,depth_mm,position_mm,velocity_mm_per_s,expected_mm,leg,motion\n"
            "1.5000,5.0000,45.0000,5.0000,45.0000,0,dip\n"
            "2.0000,-1.0000,39.0000,5.0000,,0,dip\n");
}

TEST(DipRecord, SpeedIsMeasuredOnlyUnderWater) {
  std::vector<rig::Sample> samples;
  // 20 mm/s above the water, and then 5 mm/s under water.
  for (int i = 0; i < 100; ++i) samples.push_back(sample(0.02 * i, 30 + 0.4 * i));
  for (int i = 0; i < 100; ++i) samples.push_back(sample(2 + 0.02 * i, 70 + 0.1 * i));
  const auto speed = immersion_speed(samples, 1, 70);
  EXPECT_EQ(speed.samples, 100);
  EXPECT_NEAR(speed.speed_mm_per_s, 5, 1e-9);
  EXPECT_NEAR(speed.largest_share, 0, 1e-6);
}

Facts facts() {
  Facts out;
  out.job = "jobs/7";
  out.outcome = "RUNNING";
  out.plan.depth_mm = 20;
  out.plan.simulate_job = "jobs/3";
  out.plan.water_temperature_c = 25;
  out.stand.step = Step::kSoak;
  out.stand.contact_mm = 40;
  out.steps = {{Step::kLayFilm, 10, 12, {}, "ann"}, {Step::kSoak, 12, {}, 60, ""}};
  out.warnings = {{"film_late", "late", "START_DIP"}};
  return out;
}

TEST(DipRecord, ReportHasPlannedAndActualValues) {
  const json report = json::parse(report_json(facts()));
  EXPECT_EQ(report.at("verb"), "dip");
  EXPECT_EQ(report.at("simulate_job"), "jobs/3");
  EXPECT_EQ(report.at("water_temperature_c"), 25);
  EXPECT_EQ(report.at("axis").at("contact_mm"), 40);
  EXPECT_EQ(report.at("parameters").at("depth_mm"), 20);
  EXPECT_TRUE(report.at("descent").is_null());
  const json& steps = report.at("steps");
  EXPECT_EQ(steps.at(0).at("confirmed_by"), "ann");
  EXPECT_EQ(steps.at(0).at("actual_s"), 2);
  EXPECT_EQ(steps.at(1).at("planned_s"), 60);
  EXPECT_TRUE(steps.at(1).at("end_s").is_null());
  EXPECT_EQ(report.at("warnings").at(0).at("code"), "film_late");
}

TEST(DipRecord, ReportOfALostDaemonIsInterrupted) {
  const json report = json::parse(interrupted_report(report_json(facts()), "lost"));
  EXPECT_EQ(report.at("outcome"), "INTERRUPTED");
  EXPECT_EQ(report.at("message"), "lost");
  EXPECT_EQ(report.at("step"), "SOAK");
  EXPECT_EQ(interrupted_report("{\"half", "lost"), "{\"half");
}

TEST(DipRecord, ReportIsReplacedAtomically) {
  const testing::TemporaryFolder folder;
  ASSERT_TRUE(write_report(folder.path(), "one"));
  ASSERT_TRUE(write_report(folder.path(), "two"));
  EXPECT_EQ(*read_text_file(folder.path() / "report.json", 100), "two");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "report.next"));
  const auto lost = write_report(folder.path() / "none", "x");
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().reason, "DISK_FULL");
}

}  // namespace
}  // namespace hydroprint::dip
