// Every fault of the line and of the machine, with its stated outcome.
#include <cctype>
#include <thread>
#include <tuple>

#include "tests/hardware/simulator/drive/bench_rig.h"

namespace hydroprint::simulated_drive {
namespace {

struct Outcome {
  const char* fault;
  ErrorReason reason;  ///< reason of an affected read's error
  bool timeout;        ///< whether a read's error has the metadata `timeout`
  bool is_bad = true;  ///< not a reply of the drive, so reads are repeated
};

constexpr Outcome kOutcomes[] = {
    {"late 180ms", ErrorReason::RIG_OFFLINE, true},
    {"drop", ErrorReason::RIG_OFFLINE, true},
    {"truncate", ErrorReason::RIG_OFFLINE, true},
    {"wrong-id", ErrorReason::REPLY_INVALID, false},
    {"wrong-function", ErrorReason::REPLY_INVALID, false},
    {"wrong-crc", ErrorReason::REPLY_INVALID, false},
    {"wrong-length", ErrorReason::REPLY_INVALID, false},
    {"busy", ErrorReason::DRIVE_BUSY, false, false},
};

class LineFault : public ::testing::TestWithParam<std::tuple<const char*, Outcome>> {};

TEST_P(LineFault, OfOneReplyDoesNotEndAPoll) {
  const auto& [wire, outcome] = GetParam();
  BenchRig bench(wire);
  bench.make_ready();
  bench.act(std::string("fault ") + outcome.fault);
  const auto struck = bench.drive().poll();
  EXPECT_EQ(struck.has_value(), outcome.is_bad);
  EXPECT_EQ(bench.drive().link()->statistics().retried_reads, outcome.is_bad ? 1U : 0U);
  HP_ASSERT_OK(bench.drive().poll());
}

TEST_P(LineFault, HasItsStatedErrorAndTheLinkRecovers) {
  const auto& [wire, outcome] = GetParam();
  BenchRig bench(wire);
  bench.make_ready();
  bench.act(std::string("fault ") + outcome.fault + " all");
  const auto struck = bench.drive().poll();
  ASSERT_FALSE(struck);
  EXPECT_EQ(struck.error().reason, outcome.reason) << struck.error().message;
  EXPECT_EQ(struck.error().metadata.contains("timeout"), outcome.timeout);
  bench.act("clear");
  if (outcome.is_bad) {
    const Status blind = bench.drive().move_to(5, 5);
    ASSERT_FALSE(blind) << "a move must be refused while the state is unknown";
    EXPECT_EQ(blind.error().reason, ErrorReason::RIG_OFFLINE);
  }
  HP_ASSERT_OK(bench.drive().poll());
}

TEST_P(LineFault, OfACommandSaysThatItMayHaveTakenEffect) {
  const auto& [wire, outcome] = GetParam();
  BenchRig bench(wire);
  bench.make_ready();
  const int requests = bench.truth().at("requests");
  bench.act(std::string("fault ") + outcome.fault);
  const Status moved = bench.drive().move_to(1, 10);
  ASSERT_FALSE(moved);
  EXPECT_EQ(moved.error().reason, outcome.reason) << moved.error().message;
  EXPECT_EQ(moved.error().metadata.contains("timeout"), outcome.is_bad);
  EXPECT_EQ(bench.truth().at("requests"), requests + 1) << "a command is never repeated";
}

INSTANTIATE_TEST_SUITE_P(All, LineFault,
                         ::testing::Combine(::testing::Values("tcp", "rtu"),
                                            ::testing::ValuesIn(kOutcomes)),
                         [](const auto& value) {
                           std::string name = std::string(std::get<0>(value.param)) + "_" +
                                              std::get<1>(value.param).fault;
                           for (char& c : name)
                             c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
                           return name;
                         });

class MachineFault : public OnBothWires {};
HP_ON_BOTH_WIRES(MachineFault);

TEST_P(MachineFault, SilentDriveIsOfflineAndStopsByItself) {
  BenchRig bench(GetParam());
  bench.make_ready();
  HP_ASSERT_OK(bench.drive().move_to(50, 10));
  bench.act("silent");
  for (int i = 0; i < 3; ++i) {
    if (!bench.drive().connected()) {
      EXPECT_FALSE(bench.drive().connect());
      continue;
    }
    EXPECT_EQ(bench.drive().poll().error().reason, ErrorReason::RIG_OFFLINE);
  }
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_EQ(bench.mode(), "off");
  bench.act("clear");
  HP_ASSERT_OK(bench.drive().connect());
  EXPECT_EQ(bench.drive().poll()->alarm_code, kWatchdog);
}

TEST_P(MachineFault, UnpluggingIsReportedAtOnceAndTheLinkRecovers) {
  BenchRig bench(GetParam());
  bench.make_ready();
  bench.act("unplug");
  const double took_s = seconds_of([&] {
    const auto state = bench.drive().poll();
    ASSERT_FALSE(state);
    EXPECT_EQ(state.error().reason, ErrorReason::RIG_OFFLINE);
  });
  EXPECT_LT(took_s, 0.05);
  EXPECT_FALSE(bench.drive().connected());
  const double refused_s = seconds_of([&] {
    const auto found = bench.drive().connect();
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().reason, ErrorReason::RIG_OFFLINE);
  });
  EXPECT_LT(refused_s, 0.05);
  bench.act("replug");
  HP_ASSERT_OK(bench.drive().connect());
  HP_ASSERT_OK(bench.drive().poll());
}

TEST_P(MachineFault, RebootClearsHomeAndEnable) {
  BenchRig bench(GetParam(), {.start_mm = 1});
  bench.make_ready();
  HP_ASSERT_OK(bench.drive().home());
  bench.poll_until([](const auto& state) { return state.homed && !state.moving; });
  HP_ASSERT_OK(bench.drive().move_to(30, 10));
  bench.act("reboot 300ms");
  EXPECT_FALSE(bench.drive().poll());
  std::this_thread::sleep_for(milliseconds(400));
  HP_ASSERT_OK(bench.drive().connect());
  const auto state = bench.drive().poll();
  HP_ASSERT_OK(state);
  EXPECT_FALSE(state->homed || state->enabled || state->moving);
}

TEST_P(MachineFault, StopButtonIsReportedAndNothingMovesUntilItIsReleased) {
  BenchRig bench(GetParam());
  bench.make_ready();
  HP_ASSERT_OK(bench.drive().move_to(30, 10));
  bench.act("press stop");
  const auto state = bench.poll_until([](const auto& s) { return !s.moving; });
  EXPECT_TRUE(state.stop_input);
  EXPECT_FALSE(state.enabled);
  const Status enabled = bench.drive().enable();
  ASSERT_FALSE(enabled);
  EXPECT_EQ(enabled.error().reason, ErrorReason::DRIVE_REFUSED);
  bench.act("release stop");
  std::this_thread::sleep_for(milliseconds(50));
  EXPECT_FALSE(bench.drive().poll()->moving);
  HP_ASSERT_OK(bench.drive().enable());
}

TEST_P(MachineFault, LimitSwitchStopsTheAxisAndIsNamed) {
  BenchRig bench(GetParam());
  bench.make_ready();
  HP_ASSERT_OK(bench.drive().move_to(30, 10));
  bench.act("press positive-end");
  const auto state = bench.poll_until([](const auto& s) { return s.alarm && !s.moving; });
  EXPECT_TRUE(state.positive_end);
  EXPECT_EQ(state.alarm_code, kPositiveEnd);
  EXPECT_EQ(state.alarm_text, "lower limit switch hit");
}

TEST_P(MachineFault, StallIsAnAlarm) {
  BenchRig bench(GetParam());
  bench.make_ready();
  HP_ASSERT_OK(bench.drive().move_to(30, 10));
  bench.act("stall");
  const auto state = bench.poll_until([](const auto& s) { return s.alarm; });
  EXPECT_EQ(state.alarm_code, kFollowingError);
}

TEST_P(MachineFault, FrozenPositionDivergesFromTheDrivesTrajectory) {
  BenchRig bench(GetParam());
  bench.make_ready();
  HP_ASSERT_OK(bench.drive().move_to(30, 10));
  bench.poll_until([](const auto& s) { return s.position_mm > 1; });
  bench.act("freeze");
  const auto state = bench.poll_until([](const auto& s) { return *s.demand_mm > 4; });
  EXPECT_LT(state.position_mm, 3);
  EXPECT_FALSE(state.alarm) << "the drive does not notice that its position is frozen";
}

}  // namespace
}  // namespace hydroprint::simulated_drive
