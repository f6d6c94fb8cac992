// A profile without a velocity register.
#include <thread>

#include "sim/base/input_file.h"
#include "tests/hardware/simulator/drive/bench_rig.h"
#include "tests/support/paths.h"

namespace hydroprint::simulated_drive {
namespace {

TEST(DerivedVelocity, IsTheMeanSinceTheLastPoll) {
  const testing::TemporaryFolder folder;
  std::string text = *read_text_file(testing::drive_profile_path("virtual"), 1 << 20);
  const std::size_t begin = text.find("[velocity]");
  text.erase(begin, text.find("[demand]") - begin);
  BenchRig bench("tcp", {.start_mm = 50, .profile = folder.write("drive.toml", text).string()});
  ASSERT_FALSE(bench.profile().velocity);
  bench.make_ready();
  HP_ASSERT_OK(bench.drive().move_to(100, 10));
  bench.poll_until([](const auto& s) { return std::abs(s.velocity_mm_per_s - 10) < 0.5; });
  std::this_thread::sleep_for(milliseconds(280));
  const auto after_gap = bench.drive().poll();
  HP_ASSERT_OK(after_gap);
  EXPECT_EQ(after_gap->velocity_mm_per_s, 0) << "after more than 0.25 s";
  HP_ASSERT_OK(bench.drive().connect());
  const auto first = bench.drive().poll();
  HP_ASSERT_OK(first);
  EXPECT_EQ(first->velocity_mm_per_s, 0);
}

}  // namespace
}  // namespace hydroprint::simulated_drive
