#include "daemon/jobs/plan_progress.h"

#include <gtest/gtest.h>

namespace hydroprint::daemon {
namespace {

using Progress = v1::PlanProgress;

const std::string kMesh = "assets/" + std::string(64, 'a');

/// A plan of three dips, and the jobs that name it.
class PlanOf3 : public ::testing::Test {
 protected:
  PlanOf3() {
    facts.plan_job = "jobs/7";
    facts.owners = {"ann", "bob"};
    facts.spec.mutable_object()->mutable_mesh()->set_asset(kMesh);
    facts.spec.mutable_object()->set_scale(50);
    for (int k = 0; k < 3; ++k) facts.spec.add_immersions();
    facts.has_camera = true;
  }

  /// Adds a job, newer than all others.
  v1::Job& add(v1::Job::State state) {
    v1::Job job;
    job.set_name("jobs/" + std::to_string(8 + facts.jobs.size()));
    job.set_state(state);
    return *facts.jobs.insert(facts.jobs.begin(), job);
  }
  std::string add_film(int immersion, v1::Job::State state = v1::Job::SUCCEEDED,
                       const std::string& calibration = {}) {
    v1::Job& job = add(state);
    job.mutable_simulate()->set_plan_job("jobs/7");
    job.mutable_simulate()->set_immersion(immersion);
    job.mutable_simulate()->set_calibration(calibration);
    return job.name();
  }
  std::string add_layout(const std::string& film, v1::Job::State state = v1::Job::SUCCEEDED) {
    v1::Job& job = add(state);
    job.mutable_print_image()->set_simulate_job(film);
    return job.name();
  }
  std::string add_dip(int immersion, const std::string& film, v1::Job::State state) {
    v1::Job& job = add(state);
    job.mutable_dip()->set_simulate_job(film);
    job.mutable_dip_status()->set_plan_job("jobs/7");
    job.mutable_dip_status()->set_immersion(immersion);
    if (state == v1::Job::FAILED) job.mutable_error()->set_message("the drive reports an alarm");
    return job.name();
  }
  void calibrate(const std::string& name) {
    v1::Calibration& active = facts.active.emplace();
    active.set_name(name);
    active.mutable_mesh()->set_asset(kMesh);
    active.set_scale(50);
    active.set_film("A4");
    facts.calibrations[name] = active;
  }
  std::string add_capture(v1::Job::State state, const std::string& owner = "ann") {
    v1::Job& job = add(state);
    job.mutable_capture();
    job.set_owner(owner);
    if (state == v1::Job::FAILED) job.mutable_error()->set_message("no camera was found");
    return job.name();
  }
  std::string add_calibrate(v1::Job::State state, const std::string& mesh = kMesh) {
    v1::Job& job = add(state);
    job.mutable_calibrate()->mutable_mesh()->set_asset(mesh);
    if (state == v1::Job::FAILED) job.mutable_error()->set_message("no object is in view");
    return job.name();
  }
  void do_all(int immersion) {
    const std::string film = add_film(immersion);
    add_layout(film);
    add_dip(immersion, film, v1::Job::SUCCEEDED);
  }

  Progress progress() const { return progress_of(facts); }
  Progress::Step step(int immersion) const { return progress().dips(immersion - 1).step(); }

  PlanFacts facts;
};

TEST_F(PlanOf3, BeginsWithTheFirstDip) {
  const Progress now = progress();
  ASSERT_EQ(now.dips_size(), 3);
  EXPECT_EQ(now.plan_job(), "jobs/7");
  EXPECT_EQ(now.next_immersion(), 1);
  for (const auto& dip : now.dips()) EXPECT_EQ(dip.step(), Progress::CALIBRATE);
  EXPECT_EQ(now.dips(1).instruction(), "hang the object as in the picture, then calibrate");
  EXPECT_EQ(now.dips(1).picture(), "jobs/7/artifacts/stretch-2.png");
}

TEST_F(PlanOf3, EachDipGoesThroughItsSteps) {
  for (int k = 1; k <= 3; ++k) {
    EXPECT_EQ(progress().next_immersion(), k);
    EXPECT_EQ(step(k), Progress::CALIBRATE);
    const std::string calibration = "calibrations/" + std::to_string(k);
    calibrate(calibration);
    EXPECT_EQ(step(k), Progress::SIMULATE);
    EXPECT_EQ(progress().dips(k - 1).calibration(), calibration);
    const std::string film = add_film(k, v1::Job::RUNNING, calibration);
    EXPECT_EQ(step(k), Progress::WAIT);
    EXPECT_EQ(progress().dips(k - 1).job(), film);
    facts.jobs.front().set_state(v1::Job::SUCCEEDED);
    EXPECT_EQ(step(k), Progress::LAY_OUT);
    EXPECT_EQ(progress().dips(k - 1).simulate_job(), film);
    const std::string layout = add_layout(film, v1::Job::QUEUED);
    EXPECT_EQ(step(k), Progress::WAIT);
    facts.jobs.front().set_state(v1::Job::SUCCEEDED);
    EXPECT_EQ(step(k), Progress::DIP);
    EXPECT_EQ(progress().dips(k - 1).print_image_job(), layout);
    const std::string dip = add_dip(k, film, v1::Job::WAITING_FOR_OPERATOR);
    EXPECT_EQ(step(k), Progress::CONFIRM);
    EXPECT_EQ(progress().dips(k - 1).job(), dip);
    EXPECT_EQ(progress().next_immersion(), k);
    facts.jobs.front().set_state(v1::Job::SUCCEEDED);
    facts.active->add_stale(v1::Calibration::DIPPED);
    facts.calibrations[calibration].add_stale(v1::Calibration::DIPPED);
    EXPECT_EQ(step(k), Progress::DONE);
    EXPECT_EQ(progress().dips(k - 1).dip_job(), dip);
    EXPECT_EQ(progress().dips(k - 1).print_image_job(), layout);
  }
  EXPECT_EQ(progress().next_immersion(), 0);
}

TEST_F(PlanOf3, WithoutACameraFilmsAreForThePlannedPose) {
  facts.has_camera = false;
  EXPECT_EQ(step(1), Progress::SIMULATE);
  EXPECT_EQ(progress().dips(0).calibration(), "");
  calibrate("calibrations/4");  // entered by hand
  EXPECT_EQ(progress().dips(0).calibration(), "calibrations/4");
}

TEST_F(PlanOf3, FailedDipLeavesTheOthersAndCanBeRepeated) {
  do_all(1);
  calibrate("calibrations/2");
  const std::string film = add_film(2, v1::Job::SUCCEEDED, "calibrations/2");
  add_layout(film);
  const std::string dip = add_dip(2, film, v1::Job::FAILED);
  EXPECT_EQ(step(1), Progress::DONE);
  EXPECT_EQ(step(2), Progress::DIP) << "its film is still right, if the object hangs as before";
  EXPECT_EQ(progress().dips(1).trouble(), dip + " is FAILED: the drive reports an alarm");
  EXPECT_EQ(step(3), Progress::CALIBRATE);
  EXPECT_EQ(progress().next_immersion(), 2);
  // The object was dipped, so it has to be hung and measured again.
  facts.active->add_stale(v1::Calibration::DIPPED);
  facts.calibrations["calibrations/2"].add_stale(v1::Calibration::DIPPED);
  EXPECT_EQ(step(2), Progress::CALIBRATE);
  EXPECT_EQ(progress().dips(1).simulate_job(), "");
  EXPECT_NE(progress().dips(1).trouble().find("no longer valid"), std::string::npos);
  calibrate("calibrations/3");
  EXPECT_EQ(progress().dips(1).calibration(), "calibrations/3");
}

TEST_F(PlanOf3, FailedFilmCanBeComputedAgain) {
  calibrate("calibrations/1");
  add_film(1, v1::Job::FAILED, "calibrations/1");
  facts.jobs.front().mutable_error()->set_message("out of memory");
  EXPECT_EQ(step(1), Progress::SIMULATE);
  EXPECT_EQ(progress().dips(0).trouble(), "jobs/8 is FAILED: out of memory");
  EXPECT_EQ(progress().dips(0).calibration(), "calibrations/1");
}

TEST_F(PlanOf3, CalibrationServesOnlyOneDip) {
  calibrate("calibrations/1");
  add_film(1, v1::Job::SUCCEEDED, "calibrations/1");
  EXPECT_EQ(step(2), Progress::CALIBRATE) << "that was the pose of dip 1";
}

TEST_F(PlanOf3, CalibrationOfAnotherObjectScaleOrFilmDoesNotServe) {
  calibrate("calibrations/1");
  facts.active->set_scale(1);
  EXPECT_EQ(step(1), Progress::CALIBRATE);
  calibrate("calibrations/1");
  facts.active->set_film("A3");
  EXPECT_EQ(step(1), Progress::CALIBRATE);
  calibrate("calibrations/1");
  facts.active->mutable_mesh()->set_asset("assets/" + std::string(64, 'b'));
  EXPECT_EQ(step(1), Progress::CALIBRATE);
}

TEST_F(PlanOf3, AnotherOrderIsPossible) {
  add_film(3);
  EXPECT_EQ(progress().next_immersion(), 3) << "it was begun";
  do_all(3);
  EXPECT_EQ(progress().next_immersion(), 1);
}

TEST_F(PlanOf3, RunningCalibrationIsWaitedFor) {
  v1::Job& job = add(v1::Job::RUNNING);
  job.mutable_calibrate()->mutable_mesh()->set_asset(kMesh);
  EXPECT_EQ(step(1), Progress::WAIT);
  EXPECT_EQ(progress().dips(0).job(), "jobs/8");
  EXPECT_EQ(step(2), Progress::CALIBRATE);
}

TEST_F(PlanOf3, FailedCaptureOrCalibrationIsTroubleOfTheNextDip) {
  do_all(1);
  const std::string capture = add_capture(v1::Job::FAILED);
  EXPECT_EQ(step(2), Progress::CALIBRATE);
  EXPECT_EQ(progress().dips(1).trouble(), capture + " is FAILED: no camera was found");
  EXPECT_EQ(progress().dips(0).trouble(), "");
  EXPECT_EQ(progress().dips(2).trouble(), "");
  add_capture(v1::Job::SUCCEEDED);
  EXPECT_EQ(progress().dips(1).trouble(), "") << "a newer attempt";
  const std::string calibrate = add_calibrate(v1::Job::FAILED);
  EXPECT_EQ(progress().dips(1).trouble(), calibrate + " is FAILED: no object is in view");
  add_capture(v1::Job::RUNNING);
  EXPECT_EQ(step(2), Progress::WAIT);
  EXPECT_EQ(progress().dips(1).trouble(), "");
}

TEST_F(PlanOf3, FailedCalibrationIsNotTroubleOfAnotherDip) {
  add_calibrate(v1::Job::FAILED);
  do_all(1);
  EXPECT_EQ(progress().dips(1).trouble(), "") << "the failure was before dip 1";
}

TEST_F(PlanOf3, FailedCalibrationIsOverOnceThereIsACalibration) {
  add_calibrate(v1::Job::FAILED);
  calibrate("calibrations/1");
  EXPECT_EQ(step(1), Progress::SIMULATE);
  EXPECT_EQ(progress().dips(0).trouble(), "");
}

TEST_F(PlanOf3, FailuresOfOtherObjectsAndPeopleAreNotTrouble) {
  add_calibrate(v1::Job::FAILED, "assets/" + std::string(64, 'b'));
  EXPECT_EQ(progress().dips(0).trouble(), "");
  add_capture(v1::Job::FAILED, "eve");
  EXPECT_EQ(progress().dips(0).trouble(), "");
  add_capture(v1::Job::FAILED, "bob");
  EXPECT_NE(progress().dips(0).trouble(), "");
}

TEST_F(PlanOf3, NewestFailureIsTold) {
  calibrate("calibrations/1");
  add_film(1, v1::Job::SUCCEEDED, "calibrations/1");
  facts.calibrations["calibrations/1"].add_stale(v1::Calibration::MOVED);
  facts.active->add_stale(v1::Calibration::MOVED);
  EXPECT_NE(progress().dips(0).trouble().find("is out of date"), std::string::npos);
  const std::string name = add_calibrate(v1::Job::FAILED);
  EXPECT_EQ(progress().dips(0).trouble(), name + " is FAILED: no object is in view");
}

TEST_F(PlanOf3, JobsOfOtherPlansDoNotCount) {
  add_film(1);
  facts.jobs.front().mutable_simulate()->set_plan_job("jobs/6");
  EXPECT_EQ(step(1), Progress::CALIBRATE);
  add_dip(1, "jobs/8", v1::Job::SUCCEEDED);
  facts.jobs.front().mutable_dip_status()->set_plan_job("jobs/6");
  EXPECT_EQ(step(1), Progress::CALIBRATE);
}

TEST_F(PlanOf3, WarningsOfTheFilmAreShown) {
  facts.warnings[add_film(1)].emplace_back().set_message("the object is turned");
  ASSERT_EQ(progress().dips(0).warnings_size(), 1);
  EXPECT_EQ(progress().dips(0).warnings(0).message(), "the object is turned");
}

}  // namespace
}  // namespace hydroprint::daemon
