#include "daemon/dip/job_plan.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "daemon/platform/resource_names.h"
#include "hydroprint/v1/spec.pb.h"
#include "tests/daemon/store/store_fixture.h"

namespace hydroprint::daemon {
namespace {

using nlohmann::json;

json report() {
  return {{"depth_mm", 42.5},
          {"parameters",
           {{"dip_speed_mm_per_s", 4},
            {"depth_mm", "full"},
            {"film", {{"name", "A4"}, {"min_mm", {-105, -148.5}}, {"max_mm", {105, 148.5}}}},
            {"profile", {{"activator_ml_per_m2", 18}, {"soak_s", 70}, {"activator_wait_s", 15}}}}}};
}

TEST(SimulatedDip, ValuesComeFromTheReport) {
  const auto dip = read_simulated_dip(report().dump());
  ASSERT_TRUE(dip) << dip.error().message;
  EXPECT_EQ(dip->depth_mm, 42.5);
  EXPECT_EQ(dip->speed_mm_per_s, 4);
  EXPECT_EQ(dip->film_area_mm2, 210.0 * 297.0);
  EXPECT_EQ(dip->activator_ml_per_m2, 18);
  EXPECT_EQ(dip->soak_s, 70);
  EXPECT_EQ(dip->activator_wait_s, 15);
  json round = report();
  round["parameters"]["film"] = {
      {"name", "circle:100"}, {"min_mm", {-100, -100}}, {"max_mm", {100, 100}}};
  EXPECT_NEAR(read_simulated_dip(round.dump())->film_area_mm2, std::numbers::pi * 1e4, 1e-6);
}

TEST(SimulatedDip, DipOfAPlanHasItsNumberAndWarnings) {
  json planned = report();
  planned["plan"] = {{"immersion", 2}, {"immersions", 3}};
  planned["warnings"] = {
      {{"code", "plan_pose_off"}, {"message", "turned"}, {"where", "dip 2"}},
      {{"code", "film_torn"}, {"message", "torn"}, {"where", "surface"}},
      {{"code", 7}, {"message", "wrong"}},
      "wrong",
  };
  const auto dip = read_simulated_dip(planned.dump());
  ASSERT_TRUE(dip) << dip.error().message;
  EXPECT_EQ(dip->immersion, 2);
  EXPECT_EQ(dip->immersions, 3);
  ASSERT_EQ(dip->warnings.size(), 1U);
  EXPECT_EQ(dip->warnings[0].message, "turned");
  EXPECT_EQ(read_simulated_dip(report().dump())->immersion, 0);
  planned["plan"]["immersion"] = 99;
  EXPECT_FALSE(read_simulated_dip(planned.dump()));
}

TEST(SimulatedDip, InvalidReportsAreRefused) {
  for (const char* text : {"", "{", "[]", "7", "{\"depth_mm\":\"full\"}"}) {
    EXPECT_FALSE(read_simulated_dip(text)) << text;
  }
  const auto refused = [](const char* pointer, const json& value) {
    json changed = report();
    changed[json::json_pointer(pointer)] = value;
    const auto dip = read_simulated_dip(changed.dump());
    EXPECT_FALSE(dip) << pointer << ' ' << value;
    if (dip) return;
    EXPECT_NE(dip.error().message.find(pointer), std::string::npos);
  };
  refused("/depth_mm", -1);
  refused("/depth_mm", 1e300);
  refused("/depth_mm", nullptr);
  refused("/parameters/dip_speed_mm_per_s", "5");
  refused("/parameters/profile/soak_s", 1e9);
  refused("/parameters/film/min_mm/0", json::object());
  json deep = report();
  deep["parameters"]["film"] = 3;
  EXPECT_FALSE(read_simulated_dip(deep.dump()));
}

class DipPlanOfJob : public StoreTest {
 protected:
  std::string simulate(const std::string& text) {
    const Job job = add("simulated");
    EXPECT_TRUE(jobs->start(job.id));
    std::filesystem::create_directories(layout.artifacts(job.id));
    std::ofstream(layout.artifacts(job.id) / "report.json") << text;
    EXPECT_TRUE(jobs->succeed(job.id, {{"report.json", 1, "", "application/json"}}));
    return job_name(job.id);
  }
};

TEST_F(DipPlanOfJob, SpecOverridesSimulationWhichOverridesDefaults) {
  v1::DipSpec spec;
  spec.set_simulate_job(simulate(report().dump()));
  auto plan = plan_of(spec, *jobs, layout);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->depth_mm, 42.5);
  EXPECT_EQ(plan->retract_speed_mm_per_s, 4) << "by default, the speed of the descent";
  EXPECT_EQ(plan->clocks.soak_s, 70);
  EXPECT_EQ(plan->clocks.activation_window_s, 60);
  EXPECT_EQ(plan->clearance_mm, 20);
  EXPECT_TRUE(plan->warnings.empty());
  spec.set_depth_mm(50);
  spec.set_soak_s(5);
  plan = plan_of(spec, *jobs, layout);
  EXPECT_EQ(plan->depth_mm, 50);
  EXPECT_EQ(plan->clocks.soak_s, 5);
  EXPECT_EQ(plan->warnings.at(0).code, "deeper_than_simulated");
}

TEST_F(DipPlanOfJob, SimulationMustHaveSucceeded) {
  v1::DipSpec spec;
  spec.set_simulate_job("jobs/77");
  EXPECT_EQ(plan_of(spec, *jobs, layout).error().reason, "JOB_NOT_FOUND");
  spec.set_simulate_job(job_name(add("queued").id));
  EXPECT_EQ(plan_of(spec, *jobs, layout).error().reason, "STATE_FORBIDS");
  spec.set_simulate_job(simulate("no report"));
  EXPECT_EQ(plan_of(spec, *jobs, layout).error().reason, "STATE_FORBIDS");
}

}  // namespace
}  // namespace hydroprint::daemon
