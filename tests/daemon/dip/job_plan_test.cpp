#include "daemon/dip/job_plan.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>

#include "daemon/platform/resource_names.h"
#include "hydroprint/v1/report.pb.h"
#include "hydroprint/v1/spec.pb.h"
#include "proto/warning_message.h"
#include "proto/write_json.h"
#include "tests/daemon/store/store_fixture.h"

namespace hydroprint::daemon {
namespace {

v1::SimulateReport report() {
  v1::SimulateReport out;
  out.mutable_flow()->set_depth_mm(42.5);
  v1::DipFacts& dip = *out.mutable_parameters()->mutable_dip();
  dip.set_dip_speed_mm_per_s(4);
  dip.mutable_film()->set_name("A4");
  for (const double x : {-105.0, -148.5}) dip.mutable_film()->add_min_mm(x);
  for (const double x : {105.0, 148.5}) dip.mutable_film()->add_max_mm(x);
  dip.mutable_profile()->set_activator_ml_per_m2(18);
  dip.mutable_profile()->set_soak_s(70);
  dip.mutable_profile()->set_activator_wait_s(15);
  return out;
}

TEST(SimulatedDip, ValuesComeFromTheReport) {
  const auto dip = read_simulated_dip(report());
  ASSERT_TRUE(dip) << dip.error().message;
  EXPECT_EQ(dip->depth_mm, 42.5);
  EXPECT_EQ(dip->speed_mm_per_s, 4);
  EXPECT_EQ(dip->film_area_mm2, 210.0 * 297.0);
  EXPECT_EQ(dip->activator_ml_per_m2, 18);
  EXPECT_EQ(dip->soak_s, 70);
  EXPECT_EQ(dip->activator_wait_s, 15);
  v1::SimulateReport round = report();
  v1::FilmFacts& film = *round.mutable_parameters()->mutable_dip()->mutable_film();
  film.Clear();
  film.set_name("circle:100");
  for (int i = 0; i < 2; ++i) {
    film.add_min_mm(-100);
    film.add_max_mm(100);
  }
  EXPECT_NEAR(read_simulated_dip(round)->film_area_mm2, std::numbers::pi * 1e4, 1e-6);
}

TEST(SimulatedDip, DipOfAPlanHasItsNumberAndWarnings) {
  v1::SimulateReport planned = report();
  planned.mutable_plan()->set_immersion(2);
  planned.mutable_plan()->set_immersions(3);
  add_warnings({{WarningCode::PLAN_POSE_OFF, "turned", {{}, 2}},
                {WarningCode::FILM_TORN, "torn", {OnSurface{}}}},
               *planned.mutable_run()->mutable_warnings());
  const auto dip = read_simulated_dip(planned);
  ASSERT_TRUE(dip) << dip.error().message;
  EXPECT_EQ(dip->immersion, 2);
  EXPECT_EQ(dip->immersions, 3);
  ASSERT_EQ(dip->warnings.size(), 1U);
  EXPECT_EQ(dip->warnings[0].message, "turned");
  EXPECT_EQ(dip->warnings[0].where.dip, 2);
  EXPECT_EQ(read_simulated_dip(report())->immersion, 0);
  planned.mutable_plan()->set_immersion(99);
  EXPECT_FALSE(read_simulated_dip(planned));
}

TEST(SimulatedDip, ValuesOutOfRangeAreRefusedByName) {
  EXPECT_FALSE(read_simulated_dip(v1::SimulateReport()));
  const auto refusal = [](const std::function<void(v1::SimulateReport&)>& change) {
    v1::SimulateReport changed = report();
    change(changed);
    const auto dip = read_simulated_dip(changed);
    return dip ? "taken" : dip.error().message;
  };
  for (const double depth_mm : {-1.0, 0.0, 1e300}) {
    const auto deep = [&](auto& changed) { changed.mutable_flow()->set_depth_mm(depth_mm); };
    EXPECT_NE(refusal(deep).find("depth_mm"), std::string::npos);
  }
  const auto soaks = [](auto& changed) {
    changed.mutable_parameters()->mutable_dip()->mutable_profile()->set_soak_s(1e9);
  };
  EXPECT_NE(refusal(soaks).find("soak_s"), std::string::npos);
  const auto bare = [](auto& changed) {
    changed.mutable_parameters()->mutable_dip()->clear_film();
  };
  EXPECT_NE(refusal(bare).find("film"), std::string::npos);
}

class DipPlanOfJob : public StoreTest {
 protected:
  std::string simulate(const std::string& text) {
    const Job job = add("simulated");
    EXPECT_TRUE(jobs->start(job.id));
    std::filesystem::create_directories(layout.artifacts(job.id));
    std::ofstream(layout.artifacts(job.id) / "report.json") << text;
    EXPECT_TRUE(jobs->succeed(job.id, {{"report.json", static_cast<std::int64_t>(text.size()),
                                        sha256(text), "application/json"}}));
    return job_name(job.id);
  }
};

TEST_F(DipPlanOfJob, SpecOverridesSimulationWhichOverridesDefaults) {
  v1::DipSpec spec;
  spec.set_simulate_job(simulate(*json_file_of(report())));
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
  EXPECT_EQ(plan->warnings.at(0).code, WarningCode::DEEPER_THAN_SIMULATED);
}

TEST_F(DipPlanOfJob, SimulationMustHaveSucceeded) {
  v1::DipSpec spec;
  spec.set_simulate_job("jobs/77");
  EXPECT_EQ(plan_of(spec, *jobs, layout).error().reason, ErrorReason::JOB_NOT_FOUND);
  spec.set_simulate_job(job_name(add("queued").id));
  EXPECT_EQ(plan_of(spec, *jobs, layout).error().reason, ErrorReason::STATE_FORBIDS);
  spec.set_simulate_job(simulate("no report"));
  EXPECT_EQ(plan_of(spec, *jobs, layout).error().reason, ErrorReason::STATE_FORBIDS);
}

}  // namespace
}  // namespace hydroprint::daemon
