// The dip from the operator's view, with hydroprintd and hydroprint-virtual-rig.
#include <gtest/gtest.h>
#include <signal.h>
#include <sqlite3.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <thread>

#include "sim/base/input_file.h"
#include "tests/daemon/api/rig_support.h"
#include "tests/support/paths.h"

namespace hydroprint::tests {
namespace {

using std::chrono::milliseconds;

constexpr double kContact_mm = 8;
constexpr double kClearance_mm = 3;  // value in short_dip()

class DipApi : public RigTest {
 protected:
  void SetUp() override {
    ann.make_ready();
    ann.go_to(kContact_mm);
  }
  /// Starts a dip and returns its name in the middle of the descent.
  std::string descending(double depth_mm = 40, double speed_mm_per_s = 10) {
    v1::DipSpec spec = short_dip();
    spec.set_depth_mm(depth_mm);
    spec.set_speed_mm_per_s(speed_mm_per_s);
    const std::string name = ann.dip(spec).name();
    EXPECT_EQ(ann.guide_to(name, v1::DipStatus::DESCEND).dip_status().step(),
              v1::DipStatus::DESCEND);
    EXPECT_TRUE(wait_until([&] { return rig.position_mm() > kContact_mm + 3; }));
    return name;
  }
  std::vector<v1::DipStatus::Step> steps(const std::string& name) {
    std::vector<v1::DipStatus::Step> out;
    for (const auto& event : ann.events(name)) {
      v1::DipStatus::Step step = v1::DipStatus::STEP_UNSPECIFIED;
      if (event.kind() != v1::JobEvent::STATE_CHANGED) continue;
      if (v1::DipStatus::Step_Parse(event.phase(), &step)) out.push_back(step);
    }
    return out;
  }
  void expect_rest() {
    EXPECT_EQ(rig.speed_mm_per_s(), 0);
    const double rest_mm = rig.position_mm();
    std::this_thread::sleep_for(milliseconds(100));
    EXPECT_EQ(rig.position_mm(), rest_mm);
  }
};

/// Rows of positions.csv for the motion "dip", as numbers, without the column of the motion's name.
std::vector<std::vector<double>> positions(const std::string& csv) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "t_s,depth_mm,position_mm,velocity_mm_per_s,expected_mm,leg,motion");
  while (std::getline(lines, line)) {
    if (!line.ends_with(",dip")) continue;
    std::istringstream fields(line);
    std::vector<double> row;
    for (std::string field; row.size() < 6 && std::getline(fields, field, ',');) {
      row.push_back(field.empty() ? NAN : std::stod(field));
    }
    rows.push_back(row);
  }
  return rows;
}

TEST_F(DipApi, GuidesAnOperatorThroughAWholeDip) {
  v1::DipSpec spec = short_dip();
  spec.set_depth_mm(12);
  spec.set_soak_s(1);
  spec.set_water_temperature_c(25.5);
  const v1::Job made = ann.dip(spec);
  EXPECT_EQ(made.state(), v1::Job::WAITING_FOR_OPERATOR);
  EXPECT_EQ(made.dip_status().step(), v1::DipStatus::PRINT_FILM);
  EXPECT_FALSE(made.dip_status().instruction().empty());
  EXPECT_EQ(ann.rig().dip(), made.name());
  const std::string& name = made.name();

  const v1::Job soaking = ann.guide_to(name, v1::DipStatus::SOAK);
  EXPECT_EQ(soaking.state(), v1::Job::RUNNING);
  EXPECT_EQ(soaking.eta_origin(), v1::Job::DIP);
  EXPECT_NEAR(soaking.dip_status().contact_mm(), kContact_mm, 0.1);
  const auto& soak_end = soaking.dip_status().step_end_time();
  EXPECT_LE(soak_end.seconds() - soaking.update_time().seconds(), 2);
  EXPECT_GT(soaking.progress_fraction(), 0);
  EXPECT_NEAR(rig.position_mm(), kContact_mm - kClearance_mm, 0.1)
      << "the object is above the water, so that the film can be laid";

  ann.guide_to(name, v1::DipStatus::DESCEND);
  EXPECT_EQ(ann.rig().state(), v1::Rig::DIPPING);
  const v1::Job ended = ann.wait_for_end(name);
  ASSERT_EQ(ended.state(), v1::Job::SUCCEEDED) << ended.error().message();
  EXPECT_EQ(ended.progress_fraction(), 1);
  EXPECT_EQ(ann.rig().dip(), "");
  EXPECT_EQ(
      steps(name),
      (std::vector{v1::DipStatus::LOAD_OBJECT, v1::DipStatus::FIND_CONTACT, v1::DipStatus::CLEAR,
                   v1::DipStatus::LAY_FILM, v1::DipStatus::SOAK, v1::DipStatus::SPRAY_ACTIVATOR,
                   v1::DipStatus::ACTIVATE, v1::DipStatus::START_DIP, v1::DipStatus::DESCEND,
                   v1::DipStatus::HOLD, v1::DipStatus::RETRACT}));

  const auto report = ann.report(name);
  EXPECT_EQ(report.at("outcome"), "SUCCEEDED");
  EXPECT_EQ(report.at("lease_holder"), "ann");
  EXPECT_EQ(report.at("parameters").at("water_temperature_c"), 25.5);
  EXPECT_NEAR(report.at("depth_reached_mm"), 12, 0.1);
  EXPECT_NEAR(report.at("descent").at("speed_mm_per_s"), 10, 0.01);
  EXPECT_LT(report.at("descent").at("largest_deviation_share"), 0.02);
  EXPECT_GT(report.at("descent").at("samples"), 30);
  const auto& soak = report.at("steps").at(5);
  EXPECT_EQ(soak.at("step"), "SOAK");
  EXPECT_EQ(soak.at("planned_s"), 1);
  EXPECT_NEAR(soak.at("actual_s"), 1, 0.1);
  EXPECT_EQ(report.at("steps").at(4).at("confirmed_by"), "ann");

  const auto rows = positions(ann.download(name + "/artifacts/positions.csv"));
  // 15 mm down, 0.3 s at rest and 15 mm up at 10 mm/s take over 3 s, with at least 20 samples/s.
  EXPECT_GT(rows.size(), 20 * 3U);
  double deepest_mm = 0, longest_s = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_NEAR(rows[i][1], rows[i][2] - kContact_mm, 0.11);
    deepest_mm = std::max(deepest_mm, rows[i][1]);
    if (i > 0) longest_s = std::max(longest_s, rows[i][0] - rows[i - 1][0]);
  }
  EXPECT_NEAR(deepest_mm, 12, 0.1);
  EXPECT_LT(longest_s, 0.1) << "time between two samples, in s";
}

TEST_F(DipApi, SkipsConfirmationsAndClocksOnTheVirtualRig) {
  v1::DipSpec spec = short_dip();
  spec.set_soak_s(600);
  spec.set_yes_to_all(true);
  const std::string name = ann.dip(spec).name();
  const v1::Job ended = ann.wait_for_end(name);
  ASSERT_EQ(ended.state(), v1::Job::SUCCEEDED) << ended.error().message();
  EXPECT_NEAR(ended.dip_status().contact_mm(), kContact_mm, 0.1);
  EXPECT_NEAR(rig.position_mm(), kContact_mm - kClearance_mm, 0.1);
  EXPECT_NEAR(ann.report(name).at("depth_reached_mm"), 5, 0.1);
}

TEST_F(DipApi, ImpossibleDipIsRefusedBeforeAnyMotion) {
  const double rest_mm = rig.position_mm();
  v1::Job job;
  v1::DipSpec spec = short_dip();
  spec.set_depth_mm(296);
  EXPECT_EQ(reason_of(ann.create_dip(spec, job)), "LIMIT_EXCEEDED");
  spec = short_dip();
  spec.set_speed_mm_per_s(10.5);
  EXPECT_EQ(reason_of(ann.create_dip(spec, job)), "LIMIT_EXCEEDED");
  spec = short_dip();
  spec.set_hold_s(NAN);
  EXPECT_EQ(reason_of(ann.create_dip(spec, job)), "SPEC_INVALID");
  spec = short_dip();
  spec.clear_depth_mm();
  EXPECT_EQ(reason_of(ann.create_dip(spec, job)), "SPEC_INVALID");
  spec.set_simulate_job("jobs/99");
  EXPECT_EQ(reason_of(ann.create_dip(spec, job)), "JOB_NOT_FOUND");
  RigClient bob(daemon.address(), "bob");
  EXPECT_EQ(reason_of(bob.create_dip(short_dip(), job)), "LEASE_REQUIRED");
  const std::string open = ann.dip(short_dip()).name();
  EXPECT_EQ(reason_of(ann.create_dip(short_dip(), job)), "STATE_FORBIDS") << "another dip is open";
  ann.cancel(open);
  ann.wait_for_end(open);
  v1::RetryJobRequest retry;
  retry.set_name(open);
  EXPECT_EQ(reason_of(ann.jobs->RetryJob(ann.context().get(), retry, &job)), "STATE_FORBIDS");
  ASSERT_TRUE(ann.disarm().ok());
  EXPECT_EQ(reason_of(ann.create_dip(short_dip(), job)), "STATE_FORBIDS");
  ASSERT_TRUE(ann.arm().ok());
  EXPECT_EQ(reason_of(ann.create_dip(short_dip(), job)), "RIG_NOT_HOMED");
  EXPECT_EQ(rig.position_mm(), rest_mm);
}

TEST_F(DipApi, FirstContactOutOfReachIsRefusedAndTheDipWaits) {
  v1::DipSpec spec = short_dip();
  spec.set_depth_mm(292);
  const std::string name = ann.dip(spec).name();
  ann.guide_to(name, v1::DipStatus::FIND_CONTACT);
  const auto refused = ann.confirm(name, v1::DipStatus::FIND_CONTACT);
  EXPECT_EQ(refused.error_code(), grpc::OUT_OF_RANGE);
  EXPECT_EQ(reason_of(refused), "LIMIT_EXCEEDED");
  EXPECT_EQ(error_info(refused).metadata().at("max"), "298");
  EXPECT_EQ(ann.job(name).dip_status().step(), v1::DipStatus::FIND_CONTACT);
  ann.go_to(5.5);  // contact position of an object that hangs lower
  EXPECT_TRUE(ann.confirm(name, v1::DipStatus::FIND_CONTACT).ok());
  ann.wait_for_step(name, v1::DipStatus::LAY_FILM);
}

TEST_F(DipApi, ConfirmationCountsForOneStepOnly) {
  const std::string name = ann.dip(short_dip()).name();
  EXPECT_EQ(reason_of(ann.confirm(name, v1::DipStatus::LOAD_OBJECT)), "STATE_FORBIDS");
  EXPECT_EQ(reason_of(ann.confirm(name, v1::DipStatus::SOAK)), "STATE_FORBIDS");
  EXPECT_EQ(reason_of(ann.confirm(name, v1::DipStatus::STEP_UNSPECIFIED)), "SPEC_INVALID");
  ASSERT_TRUE(ann.confirm(name, v1::DipStatus::PRINT_FILM).ok());
  EXPECT_TRUE(ann.confirm(name, v1::DipStatus::PRINT_FILM).ok())
      << "confirming again is not an error";
  EXPECT_EQ(ann.job(name).dip_status().step(), v1::DipStatus::LOAD_OBJECT);
  RigClient bob(daemon.address(), "bob");
  EXPECT_EQ(reason_of(bob.confirm(name, v1::DipStatus::LOAD_OBJECT)), "LEASE_REQUIRED");
}

TEST_F(DipApi, OnlyTheDipMovesTheRigAfterFirstContact) {
  const std::string name = ann.dip(short_dip()).name();
  ann.guide_to(name, v1::DipStatus::FIND_CONTACT);
  while (rig.position_mm() < kContact_mm + 1.5) {
    ASSERT_TRUE(ann.jog(5).ok());
    std::this_thread::sleep_for(milliseconds(50));
  }
  EXPECT_EQ(reason_of(ann.confirm(name, v1::DipStatus::FIND_CONTACT)), "MOTION_IN_PROGRESS");
  ASSERT_TRUE(ann.becomes(v1::Rig::IDLE));
  const double contact_mm = rig.position_mm();
  EXPECT_GT(contact_mm, kContact_mm + 1);
  ASSERT_TRUE(wait_until([&] { return ann.confirm(name, v1::DipStatus::FIND_CONTACT).ok(); }, 2));
  EXPECT_NEAR(ann.wait_for_step(name, v1::DipStatus::LAY_FILM).dip_status().contact_mm(),
              contact_mm, 0.1);
  for (const grpc::Status& refused :
       {ann.jog(5), ann.move_to(5), ann.home(), ann.disarm(), ann.arm()}) {
    EXPECT_EQ(reason_of(refused), "STATE_FORBIDS");
    EXPECT_EQ(error_info(refused).metadata().at("dip"), name);
  }
  ann.cancel(name);
  ann.wait_for_end(name);
  EXPECT_TRUE(ann.jog(-5).ok());
}

TEST_F(DipApi, LateFilmIsDippedWithAWarning) {
  v1::DipSpec spec = short_dip();
  spec.set_activation_window_s(1);
  const std::string name = ann.dip(spec).name();
  const v1::Job ready = ann.guide_to(name, v1::DipStatus::START_DIP);
  EXPECT_TRUE(ready.dip_status().has_activation_end_time());
  const v1::Job late =
      ann.wait(name, [](const v1::Job& job) { return job.dip_status().warnings_size() > 0; });
  EXPECT_EQ(late.dip_status().step(), v1::DipStatus::START_DIP);
  EXPECT_TRUE(ann.confirm(name, v1::DipStatus::START_DIP).ok());
  EXPECT_EQ(ann.wait_for_end(name).state(), v1::Job::SUCCEEDED);
  EXPECT_EQ(ann.report(name).at("run").at("warnings").at(0).at("code"), "FILM_LATE");
}

TEST_F(DipApi, CancelAtAnyStepGivesAdviceAndKeepsTheRecord) {
  for (int i = v1::DipStatus::PRINT_FILM; i <= v1::DipStatus::RETRACT; ++i) {
    const auto step = static_cast<v1::DipStatus::Step>(i);
    SCOPED_TRACE(v1::DipStatus::Step_Name(step));
    if (ann.rig().state() != v1::Rig::IDLE) ann.make_ready();
    ann.go_to(kContact_mm);
    v1::DipSpec spec = short_dip();
    // Lengthens the step in which the dip is cancelled.
    if (step == v1::DipStatus::SOAK) spec.set_soak_s(5);
    if (step == v1::DipStatus::ACTIVATE) spec.set_activator_wait_s(5);
    if (step == v1::DipStatus::HOLD) spec.set_hold_s(5);
    const bool rises = step == v1::DipStatus::CLEAR || step == v1::DipStatus::RETRACT;
    spec.set_retract_speed_mm_per_s(rises ? 2 : 10);
    if (step == v1::DipStatus::DESCEND) spec.set_speed_mm_per_s(2);
    const std::string name = ann.dip(spec).name();
    ASSERT_EQ(ann.guide_to(name, step).dip_status().step(), step);
    ann.cancel(name);
    const v1::Job ended = ann.wait_for_end(name);
    EXPECT_EQ(ended.state(), v1::Job::CANCELLED);
    const std::string words = ann.events(name).back().message();
    EXPECT_NE(words.find("film"), std::string::npos) << words;
    EXPECT_EQ(ended.dip_status().step(), step);
    EXPECT_EQ(ann.report(name).at("outcome"), "CANCELLED");
    EXPECT_FALSE(ann.download(name + "/artifacts/positions.csv").empty());
    ASSERT_TRUE(ann.becomes(v1::Rig::IDLE));
    expect_rest();
  }
}

TEST_F(DipApi, StopByAnotherClientEndsTheMotion) {
  const std::string name = descending();
  RigClient bob(daemon.address(), "bob");
  ASSERT_TRUE(bob.stop().ok());
  EXPECT_EQ(ann.wait_for_end(name).state(), v1::Job::CANCELLED);
  expect_rest();
  EXPECT_EQ(ann.rig().state(), v1::Rig::IDLE);
}

TEST_F(DipApi, AStopThatIsNotObeyedIsNamedInEventAndReport) {
  const std::string name = descending();
  rig.act("press deaf");
  ASSERT_TRUE(ann.stop().ok());
  ASSERT_TRUE(ann.wait_for_end(name).has_end_time());
  for (const std::string& words :
       {ann.events(name).back().message(), ann.report(name).at("message").get<std::string>()}) {
    EXPECT_NE(words.find("PRESS THE STOP BUTTON ON THE RIG"), std::string::npos) << words;
    EXPECT_NE(words.find("skim the rest"), std::string::npos) << words;
  }
}

TEST_F(DipApi, StopAtRestDoesNotEndTheDip) {
  const std::string name = ann.dip(short_dip()).name();
  ann.guide_to(name, v1::DipStatus::START_DIP);
  ASSERT_TRUE(ann.stop().ok());
  ASSERT_TRUE(ann.confirm(name, v1::DipStatus::START_DIP).ok());
  EXPECT_EQ(ann.wait_for_end(name).state(), v1::Job::SUCCEEDED);
}

TEST_F(DipApi, DipContinuesWithoutOperatorAndLease) {
  const std::string name = descending(12);
  RigClient bob(daemon.address(), "bob");
  ASSERT_TRUE(bob.break_lease("the operator is gone").ok());
  EXPECT_EQ(bob.wait_for_end(name).state(), v1::Job::SUCCEEDED);
  EXPECT_NEAR(bob.report(name).at("depth_reached_mm"), 12, 0.1);
}

struct Fault {
  const char* name;
  const char* line;
  const char* reason;
};

class DipFault : public DipApi, public ::testing::WithParamInterface<Fault> {};

TEST_P(DipFault, DuringTheDescentFailsTheDipWithAReason) {
  const std::string name = descending();
  rig.act(GetParam().line);
  const v1::Job ended = ann.wait_for_end(name);
  EXPECT_EQ(ended.state(), v1::Job::FAILED);
  EXPECT_EQ(v1::ErrorReason_Name(ended.error().reason()), GetParam().reason)
      << ended.error().message();
  EXPECT_NE(ended.error().message().find("film"), std::string::npos) << ended.error().message();
  EXPECT_EQ(ended.dip_status().step(), v1::DipStatus::DESCEND);
  EXPECT_EQ(rig.speed_mm_per_s(), 0);
  const auto report = ann.report(name);
  EXPECT_EQ(report.at("outcome"), "FAILED");
  EXPECT_EQ(report.at("reason"), GetParam().reason);
  EXPECT_GT(report.at("depth_reached_mm"), 2.5);
  // 6 mm or more at 10 mm/s take at least 0.6 s, with at least 20 samples/s.
  EXPECT_GT(positions(ann.download(name + "/artifacts/positions.csv")).size(), 12U);
  EXPECT_EQ(ann.rig().dip(), "");
}

TEST_P(DipFault, WhileTheFilmSoaksFailsTheDipToo) {
  v1::DipSpec spec = short_dip();
  spec.set_soak_s(60);
  const std::string name = ann.dip(spec).name();
  ann.guide_to(name, v1::DipStatus::SOAK);
  rig.act(GetParam().line);
  // Nothing moves in this step, so nothing can stall.
  if (GetParam().name == std::string("Stall")) {
    std::this_thread::sleep_for(milliseconds(500));
    EXPECT_EQ(ann.job(name).dip_status().step(), v1::DipStatus::SOAK);
    return;
  }
  const v1::Job ended = ann.wait_for_end(name);
  EXPECT_EQ(ended.state(), v1::Job::FAILED);
  EXPECT_EQ(v1::ErrorReason_Name(ended.error().reason()), GetParam().reason)
      << ended.error().message();
}

INSTANTIATE_TEST_SUITE_P(All, DipFault,
                         ::testing::Values(Fault{"Unplug", "unplug", "RIG_OFFLINE"},
                                           Fault{"StopButton", "press stop", "STOP_BUTTON"},
                                           Fault{"Reboot", "reboot 100ms", "RIG_OFFLINE"},
                                           Fault{"Stall", "stall", "RIG_FAULTED"}),
                         [](const auto& fault) { return fault.param.name; });

TEST_F(DipApi, RigMayBeHomedBeforeFirstContact) {
  const std::string name = ann.dip(short_dip()).name();
  ann.guide_to(name, v1::DipStatus::FIND_CONTACT);
  rig.act("press stop");
  ASSERT_TRUE(ann.becomes(v1::Rig::ESTOPPED));
  EXPECT_EQ(reason_of(ann.confirm(name, v1::DipStatus::FIND_CONTACT)), "STATE_FORBIDS");
  rig.act("release stop");
  ASSERT_TRUE(wait_until([&] { return ann.reset().ok(); }, 2));
  ann.make_ready();
  ann.go_to(kContact_mm);
  ann.guide_to(name, v1::DipStatus::DESCEND);
  EXPECT_EQ(ann.wait_for_end(name).state(), v1::Job::SUCCEEDED);
}

TEST_F(DipApi, KillDuringTheDescentStopsTheRigAndInterruptsTheDip) {
  const std::string name = descending();
  daemon.kill();
  ASSERT_TRUE(rig.gets_to(0, 2));
  const double rest_mm = rig.position_mm();
  daemon.start();
  RigClient again(daemon.address(), "ann");
  again.lease_id = ann.lease_id;
  const v1::Job lost = again.job(name);
  EXPECT_EQ(lost.state(), v1::Job::INTERRUPTED);
  EXPECT_TRUE(lost.has_end_time());
  EXPECT_NE(lost.dip_status().instruction().find("film"), std::string::npos);
  EXPECT_EQ(again.rig().lease().holder(), "ann");
  EXPECT_EQ(again.rig().dip(), "");
  ASSERT_TRUE(wait_until([&] {
    const auto state = again.rig().state();
    return state == v1::Rig::FAULT || state == v1::Rig::DISARMED;
  }));
  EXPECT_FALSE(again.rig().homed());
  const std::string refused = reason_of(again.move_to(20));
  EXPECT_TRUE(refused == "RIG_FAULTED" || refused == "STATE_FORBIDS") << refused;
  const auto report = again.report(name);
  EXPECT_EQ(report.at("outcome"), "INTERRUPTED");
  EXPECT_EQ(report.at("step"), "DESCEND");
  EXPECT_GT(positions(again.download(name + "/artifacts/positions.csv")).size(), 8U)
      << "at most the last 0.25 s of samples may be missing";
  std::this_thread::sleep_for(milliseconds(500));
  EXPECT_EQ(again.job(name).state(), v1::Job::INTERRUPTED) << "the state is final";
  EXPECT_EQ(rig.position_mm(), rest_mm);
  again.reset();
  again.make_ready();
  again.go_to(kContact_mm);
  v1::DipSpec spec = short_dip();
  spec.set_yes_to_all(true);
  EXPECT_EQ(again.wait_for_end(again.dip(spec).name()).state(), v1::Job::SUCCEEDED);
}

/// Holds the write lock of a daemon's store, as if its disk did not respond.
class HeldStore {
 public:
  explicit HeldStore(const std::filesystem::path& database) {
    EXPECT_EQ(sqlite3_open(database.c_str(), &store_), SQLITE_OK);
    EXPECT_EQ(sqlite3_busy_timeout(store_, 5000), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(store_, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr), SQLITE_OK);
  }
  ~HeldStore() { sqlite3_close(store_); }
  HeldStore(const HeldStore&) = delete;
  HeldStore& operator=(const HeldStore&) = delete;

 private:
  sqlite3* store_ = nullptr;
};

TEST_F(DipApi, HangingStoreDelaysNeitherMotionNorStop) {
  // The dip is slow enough to last while the store is locked.
  const std::string name = descending(60, 2);
  {
    const HeldStore held(daemon.state() / "hydroprint.db");
    const double held_s = rig.now_s();
    EXPECT_TRUE(wait_until([&] { return rig.now_s() > held_s + 1; }));
    EXPECT_EQ(rig.speed_mm_per_s(), 2);
    const double asked_s = rig.now_s();
    EXPECT_TRUE(ann.stop().ok());
    EXPECT_LT(rig.rested_s() - asked_s, 1) << "a stop that waited for the store would take 5 s";
  }
  EXPECT_EQ(ann.wait_for_end(name).state(), v1::Job::CANCELLED);
  EXPECT_GT(ann.report(name).at("depth_reached_mm"), 4);
}

TEST_F(DipApi, DriveStopsTheDescentOfAHangingDaemon) {
  const std::string name = descending();
  ::kill(daemon.pid(), SIGSTOP);
  const double hung_s = rig.now_s(), hung_mm = rig.position_mm();
  // The drive's watchdog time and braking time, from its profile, and 0.1 s of tolerance.
  EXPECT_LT(rig.rested_s() - hung_s, 0.25 + 10.0 / 200 + 0.1);
  const double rest_mm = rig.position_mm();
  EXPECT_LT(rest_mm - hung_mm, 10 * (0.25 + 0.1) + 10.0 * 10 / (2 * 200));
  ::kill(daemon.pid(), SIGCONT);
  const v1::Job ended = ann.wait_for_end(name);
  EXPECT_EQ(ended.state(), v1::Job::FAILED);
  const std::string reason = v1::ErrorReason_Name(ended.error().reason());
  EXPECT_TRUE(reason == "RIG_FAULTED" || reason == "RIG_OFFLINE") << reason;
  EXPECT_EQ(ann.report(name).at("outcome"), "FAILED");
  EXPECT_TRUE(ann.becomes(v1::Rig::FAULT));
  EXPECT_FALSE(ann.rig().homed());
  EXPECT_EQ(rig.position_mm(), rest_mm);
}

TEST_F(DipApi, ShutdownDuringTheDescentStopsTheAxisFirst) {
  const std::string name = descending();
  EXPECT_EQ(daemon.terminate(), 0);
  EXPECT_EQ(rig.speed_mm_per_s(), 0);
  daemon.start();
  RigClient again(daemon.address(), "ann");
  EXPECT_EQ(again.job(name).state(), v1::Job::INTERRUPTED);
  EXPECT_NE(again.events(name).back().message().find("shut down"), std::string::npos);
  EXPECT_EQ(again.report(name).at("outcome"), "INTERRUPTED");
}

TEST_F(DipApi, RepeatedRequestCreatesOneDip) {
  v1::CreateJobRequest request;
  *request.mutable_job()->mutable_dip() = short_dip();
  request.set_lease_id(ann.lease_id);
  request.set_request_id("d1");
  v1::Job first, second;
  ASSERT_TRUE(ann.create(request, first).ok());
  ASSERT_TRUE(ann.create(request, second).ok());
  EXPECT_EQ(first.name(), second.name());
}

TEST_F(DipApi, PausedQueueDoesNotAffectADip) {
  ann.pause();
  const std::string name = ann.dip(short_dip()).name();
  EXPECT_EQ(ann.queue().queued_count(), 0);
  ann.guide_to(name, v1::DipStatus::DESCEND);
  EXPECT_EQ(ann.queue().running_jobs_size(), 0);
  EXPECT_EQ(ann.wait_for_end(name).state(), v1::Job::SUCCEEDED);
}

TEST(DipOfASimulation, UsesDepthSpeedAndFilmOfItsReport) {
  if (!real_worker_is_built()) GTEST_SKIP() << kNeedsRealWorker;
  const TemporaryFolder folder;
  VirtualRig rig;
  DaemonProcess::Options options;
  options.extra = rig.section();
  const DaemonProcess daemon(folder.path(), options);
  RigClient ann(daemon.address());
  // A pyramid, tip down.
  v1::CreateJobRequest request =
      simulate_request(ann.upload("v 0 0 -12\nv 9 0 0\nv 0 9 0\nv -9 0 0\nv 0 -9 0\n"
                                  "f 1 3 2\nf 1 4 3\nf 1 5 4\nf 1 2 5\nf 2 3 4 5\n"),
                       "pyramid.obj");
  v1::SimulateSpec& spec = *request.mutable_job()->mutable_simulate();
  spec.set_film("circle:50");
  spec.set_dpi(50);
  spec.set_model(v1::MODEL_STOKES);
  spec.set_artifacts(v1::ARTIFACT_SET_MAP);
  spec.set_depth_mm(6.5);
  spec.set_dip_speed_mm_per_s(9);
  v1::InputFile& profile = *spec.mutable_profile();
  profile.set_name("film.toml");
  profile.set_asset(ann.upload("soak_s = 0.2\nactivator_wait_s = 0.3\nactivator_ml_per_m2 = 20\n"));
  v1::Job simulated;
  ASSERT_TRUE(ann.create(request, simulated).ok());
  ann.make_ready();
  ann.go_to(kContact_mm);
  const auto computed = [&] {
    simulated = ann.job(simulated.name());
    return finished(simulated);
  };
  ASSERT_TRUE(wait_until(computed, 200))
      << "the simulation may be slow: workers have the lowest priority";
  ASSERT_EQ(simulated.state(), v1::Job::SUCCEEDED) << simulated.error().message();
  v1::DipSpec dip;
  dip.set_simulate_job(simulated.name());
  dip.set_clearance_mm(kClearance_mm);
  dip.set_hold_s(0.1);
  const std::string name = ann.dip(dip).name();
  EXPECT_NE(ann.job(name).dip_status().instruction().find(simulated.name()), std::string::npos);
  const v1::Job spraying = ann.guide_to(name, v1::DipStatus::SPRAY_ACTIVATOR);
  // 20 ml/m2 on a film of 50 mm radius.
  EXPECT_NE(spraying.dip_status().instruction().find("spray 0.2 ml"), std::string::npos)
      << spraying.dip_status().instruction();
  ann.guide_to(name, v1::DipStatus::DESCEND);
  ASSERT_EQ(ann.wait_for_end(name).state(), v1::Job::SUCCEEDED);
  const auto report = ann.report(name);
  EXPECT_EQ(report.at("simulate_job"), simulated.name());
  EXPECT_NEAR(report.at("depth_reached_mm"), 6.5, 0.1);
  EXPECT_NEAR(report.at("descent").at("speed_mm_per_s"), 9, 0.1);
  EXPECT_NEAR(report.at("parameters").at("film_area_mm2"), M_PI * 50 * 50, 0.1);
  EXPECT_EQ(report.at("parameters").at("soak_s"), 0.2);
  EXPECT_EQ(report.at("parameters").at("activator_wait_s"), 0.3);
}

TEST(DipOnARealDrive, AlwaysNeedsAnOperator) {
  const TemporaryFolder folder;
  VirtualRig rig;  // its own profile says that the drive is virtual
  auto options = DaemonProcess::fake();
  std::string profile = *read_text_file(testing::drive_profile_path("virtual"), 1 << 20);
  const std::string is_virtual = "virtual = true";
  profile.replace(profile.find(is_virtual), is_virtual.size(), "virtual = false");
  std::string section = rig.section();
  const std::string shipped = testing::drive_profile_path("virtual");
  section.replace(section.find(shipped), shipped.size(), folder.write("real.toml", profile));
  options.extra = section;
  const DaemonProcess daemon(folder.path(), options);
  RigClient ann(daemon.address());
  ann.make_ready();
  ann.go_to(kContact_mm);
  v1::DipSpec spec = short_dip();
  spec.set_yes_to_all(true);
  v1::Job job;
  EXPECT_EQ(reason_of(ann.create_dip(spec, job)), "STATE_FORBIDS");
}

}  // namespace
}  // namespace hydroprint::tests
