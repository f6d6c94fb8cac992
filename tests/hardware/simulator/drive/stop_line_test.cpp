// A stop has its own path to the drive.
#include "hardware/drive/stop_line.h"

#include <thread>

#include "tests/hardware/simulator/drive/bench_rig.h"

namespace hydroprint::simulated_drive {
namespace {

class Stop : public OnBothWires {};
HP_ON_BOTH_WIRES(Stop);

/// Duration of a stop while another thread waits for a reply that never arrives, before it reads
/// again.
double stop_while_stuck_s(BenchRig& bench, drive::StopLine& stop) {
  bench.act("fault drop");
  const int requests = bench.truth().at("requests");
  std::thread stuck([&] { EXPECT_TRUE(bench.drive().poll()); });
  while (bench.truth().at("requests") == requests) std::this_thread::sleep_for(milliseconds(1));
  const double out_s = seconds_of([&] { EXPECT_TRUE(stop.stop(milliseconds(1000))); });
  stuck.join();
  return out_s;
}

TEST(StopTcp, DoesNotWaitForABlockedThread) {
  BenchRig bench("tcp");
  bench.make_ready();
  drive::StopLine stop(bench.drive());
  HP_ASSERT_OK(stop.connect());
  HP_ASSERT_OK(bench.drive().move_to(100, 10));
  EXPECT_LT(stop_while_stuck_s(bench, stop), 0.08)
      << "a stop after the blocked thread would take 0.1 s";
  std::this_thread::sleep_for(milliseconds(60));
  EXPECT_EQ(bench.mode(), "hold") << "the stop must stop the drive before its watchdog does";
}

TEST(StopSerial, PrecedesOtherRequestsOnTheLine) {
  BenchRig bench("rtu");
  bench.make_ready();
  drive::StopLine stop(bench.drive());
  HP_ASSERT_OK(bench.drive().move_to(100, 10));
  // The stop waits at most for the rest of the other thread's 0.1 s and for its own transmission,
  // but not for the silence after the timeout.
  EXPECT_LT(stop_while_stuck_s(bench, stop), 0.1 + 0.04);
  std::this_thread::sleep_for(milliseconds(60));
  EXPECT_EQ(bench.mode(), "hold");
}

TEST_P(Stop, ConnectsByItselfAndReportsFailure) {
  BenchRig bench(GetParam());
  bench.make_ready();
  drive::StopLine stop(bench.drive());
  HP_ASSERT_OK(bench.drive().move_to(100, 10));
  HP_ASSERT_OK(stop.stop(milliseconds(500)));
  bench.poll_until([](const auto& state) { return !state.moving; });
  bench.act("unplug");
  const double took_s = seconds_of([&] {
    const Status stopped = stop.stop(milliseconds(100));
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().reason, ErrorReason::RIG_OFFLINE);
  });
  EXPECT_LT(took_s, 0.3);
  bench.act("replug");
  HP_ASSERT_OK(stop.stop(milliseconds(500)));
}

TEST_P(Stop, IsRepeatedUntilItIsConfirmed) {
  BenchRig bench(GetParam());
  bench.make_ready();
  drive::StopLine stop(bench.drive());
  HP_ASSERT_OK(stop.connect());
  HP_ASSERT_OK(bench.drive().move_to(100, 10));
  bench.act("fault drop 2");
  HP_ASSERT_OK(stop.stop(milliseconds(1000)));
}

TEST(StopTcp, ItsConnectionDoesNotFeedTheWatchdog) {
  BenchRig bench("tcp");
  bench.make_ready();
  drive::StopLine stop(bench.drive());
  HP_ASSERT_OK(stop.connect());
  HP_ASSERT_OK(bench.drive().move_to(100, 10));
  std::this_thread::sleep_for(milliseconds(400));
  EXPECT_EQ(bench.truth().at("alarm_code"), kWatchdog);
}

}  // namespace
}  // namespace hydroprint::simulated_drive
