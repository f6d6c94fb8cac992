#include "daemon/dip/record.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "proto/write_json.h"
#include "sim/base/input_file.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::dip {
namespace {

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
  out.warnings = {{WarningCode::FILM_LATE, "late", {OfItem{"START_DIP"}}}};
  return out;
}

TEST(DipRecord, ReportHasPlannedAndActualValues) {
  const v1::DipReport report = report_of(facts());
  EXPECT_EQ(report.run().verb(), "dip");
  EXPECT_EQ(report.simulate_job(), "jobs/3");
  EXPECT_EQ(report.parameters().water_temperature_c(), 25);
  EXPECT_EQ(report.axis().contact_mm(), 40);
  EXPECT_EQ(report.parameters().depth_mm(), 20);
  EXPECT_FALSE(report.has_descent());
  EXPECT_EQ(report.steps(0).confirmed_by(), "ann");
  EXPECT_EQ(report.steps(0).actual_s(), 2);
  EXPECT_EQ(report.steps(1).planned_s(), 60);
  EXPECT_FALSE(report.steps(1).has_end_s());
  EXPECT_EQ(report.run().warnings(0).code(), v1::Warning::FILM_LATE);
  EXPECT_EQ(report.run().warnings(0).where().item(), "START_DIP");
}

TEST(DipRecord, ReportIsReplacedAtomically) {
  const testing::TemporaryFolder folder;
  ASSERT_TRUE(write_report(folder.path(), v1::DipReport()));
  ASSERT_TRUE(write_report(folder.path(), report_of(facts())));
  EXPECT_EQ(*read_text_file(folder.path() / "report.json", 10000),
            *json_file_of(report_of(facts())));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "report.next"));
  const auto lost = write_report(folder.path() / "none", v1::DipReport());
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().reason, ErrorReason::DISK_FULL);
}

}  // namespace
}  // namespace hydroprint::dip
