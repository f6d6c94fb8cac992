// Runs the profiles of real drives on the virtual rig. This checks their consistency, not that they
// match the hardware.
#include <cmath>

#include "sim/base/input_file.h"
#include "tests/hardware/simulator/drive/bench_rig.h"
#include "tests/support/paths.h"

namespace hydroprint::simulated_drive {
namespace {

constexpr const char* kInventedWatchdog = R"(
[watchdog]
largest_time_s = 0.25
time = { space = "holding", address = 0x7f00, words = 1, counts_per_s = 1000.0 }
always_stops = true
)";

class RealDrive : public ::testing::TestWithParam<const char*> {
 protected:
  static std::string path() { return testing::drive_profile_path(GetParam()); }

  /// Options with the profile as shipped. `with_watchdog` adds an invented watchdog if the profile
  /// has none, so that the drive may move.
  [[nodiscard]] testing::VirtualRigOptions options(bool with_watchdog) const {
    testing::VirtualRigOptions out{.start_mm = 2, .profile = path()};
    if (!with_watchdog || drive::read_drive_profile(path())->watchdog) return out;
    const std::string text = *read_text_file(path(), 1 << 20) + kInventedWatchdog;
    out.profile = folder_.write("drive.toml", text).string();
    return out;
  }

 private:
  testing::TemporaryFolder folder_;
};
INSTANTIATE_TEST_SUITE_P(All, RealDrive, ::testing::Values("leadshine_em2rs", "oriental_az"),
                         [](const auto& value) { return std::string(value.param); });

TEST_P(RealDrive, IsArmedOnlyIfItHasAWatchdog) {
  BenchRig bench("rtu", options(false));
  const auto found = bench.drive().connect();
  HP_ASSERT_OK(found);
  EXPECT_EQ(found->unsafe.has_value(), !bench.profile().watchdog);
  const auto state = bench.drive().poll();
  HP_ASSERT_OK(state);
  EXPECT_FALSE(state->moving || state->alarm || state->homed || state->stop_input);
}

TEST_P(RealDrive, HomesMovesJogsAndStopsWithItsOwnRegisters) {
  BenchRig bench("rtu", options(true));
  bench.make_ready();
  HP_ASSERT_OK(bench.drive().home());
  bench.poll_until([](const auto& state) { return state.homed && !state.moving; });
  HP_ASSERT_OK(bench.drive().move_to(3, 10));
  auto state = bench.poll_until([](const auto& s) { return s.position_mm > 0.5; });
  EXPECT_TRUE(state.moving);
  state = bench.poll_until([](const auto& s) { return !s.moving; });
  EXPECT_NEAR(state.position_mm, 3, 0.01);
  for (const double speed : {-5.0, 5.0}) {
    state = bench.poll_until([&](const auto& s) {
      EXPECT_TRUE(bench.drive().jog(speed));
      return std::abs(s.velocity_mm_per_s - speed) < 0.1;
    });
    HP_ASSERT_OK(bench.drive().stop());
    bench.poll_until([](const auto& s) { return !s.moving; });
  }
  bench.act("press stop");
  state = bench.poll_until([](const auto& s) { return !s.enabled; });
  EXPECT_TRUE(state.stop_input);
}

TEST_P(RealDrive, IsPolledAtTwentyHertzOrBetter) {
  BenchRig bench("rtu", options(false));
  HP_ASSERT_OK(bench.drive().connect());
  EXPECT_LT(seconds_of([&] {
              for (int i = 0; i < 10; ++i) HP_ASSERT_OK(bench.drive().poll());
            }),
            10 * 0.05);
}

}  // namespace
}  // namespace hydroprint::simulated_drive
