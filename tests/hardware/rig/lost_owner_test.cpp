// If the owner of the drive dies or hangs during a dip, the drive must stop without it.
#include <gtest/gtest.h>

#include <csignal>
#include <random>
#include <thread>

#include "hardware/rig/limits.h"
#include "hardware/rig/stop_channel.h"
#include "sim/base/input_file.h"
#include "tests/hardware/rig/wired_rig.h"
#include "tests/support/campaign.h"
#include "tests/support/paths.h"

namespace hydroprint::rig {
namespace {

constexpr double kSpeed_mm_per_s = 10;

class LostOwner : public simulated_drive::OnBothWires {};
HP_ON_BOTH_WIRES(LostOwner);

testing::Process own(BenchRig& drive) {
  return testing::Process({testing::program_path("rig_owner"), drive.address(),
                           testing::drive_profile_path("virtual")});
}

bool is_dipping(BenchRig& drive) {
  return drive.speed_mm_per_s() > 0.99 * kSpeed_mm_per_s && drive.position_mm() > 2;
}

/// Expects that, from now on, the drive stops within the time and distance of its own watchdog.
void expect_to_stop_by_itself(BenchRig& drive) {
  const drive::DriveProfile& profile = drive.profile();
  const double watchdog_s = profile.watchdog->largest_time_s;
  const double brake_s = kSpeed_mm_per_s / profile.stopping_deceleration_mm_per_s2;
  const double from_mm = drive.position_mm();
  const double begun_s = drive.now_s();
  EXPECT_LT(drive.rested_s() - begun_s, watchdog_s + brake_s + 0.1);
  EXPECT_LE(drive.position_mm() - from_mm,
            drive::stopping_distance_mm(profile, kSpeed_mm_per_s, watchdog_s) + 0.2);
  EXPECT_LE(drive.position_mm() - from_mm, RigConfig{}.keep_out_mm);
}

/// Expects that a new owner starts no motion and requires reset, arming and homing.
void expect_a_cold_start(BenchRig& drive) {
  const double rest_mm = drive.position_mm();
  const auto next = Controller::make({}, drive.profile(), drive.endpoint());
  ASSERT_TRUE(next);
  const auto condition = [&] { return (*next)->snapshot().condition; };
  ASSERT_TRUE(wait_until([&] { return condition().link == Link::kSafe; }))
      << (*next)->trouble().value_or(Error{}).message;
  // The state is FAULT after the drive's alarm, or DISARMED if the owner stopped the drive before.
  const std::string refused = refusal((*next)->move_to(20, 5));
  EXPECT_TRUE(refused == "RIG_FAULTED" || refused == "STATE_FORBIDS") << refused;
  EXPECT_EQ(refusal((*next)->reset()), "");
  EXPECT_EQ(refusal((*next)->arm()), "");
  EXPECT_EQ(refusal((*next)->move_to(20, 5)), "RIG_NOT_HOMED");
  EXPECT_EQ(drive.position_mm(), rest_mm);
}

TEST_P(LostOwner, TheDriveStopsByItselfWhenTheOwnerIsKilled) {
  std::mt19937 random(testing::campaign_seed(1));
  std::uniform_int_distribution<int> moment_ms(0, 400);
  for (int i = 0; i < testing::campaign_rounds(4); ++i) {
    BenchRig drive(GetParam(), {.start_mm = 1});
    testing::Process owner = own(drive);
    ASSERT_TRUE(wait_until([&] { return is_dipping(drive); }, 20));
    std::this_thread::sleep_for(std::chrono::milliseconds(moment_ms(random)));
    owner.signal(SIGKILL);
    expect_to_stop_by_itself(drive);
    owner.wait();
    expect_a_cold_start(drive);
  }
}

TEST_P(LostOwner, TheDriveStopsByItselfWhenTheOwnerHangs) {
  BenchRig drive(GetParam(), {.start_mm = 1});
  testing::Process owner = own(drive);
  ASSERT_TRUE(wait_until([&] { return is_dipping(drive); }, 20));
  owner.signal(SIGSTOP);
  expect_to_stop_by_itself(drive);
  const double rest_mm = drive.position_mm();
  owner.signal(SIGCONT);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  EXPECT_TRUE(owner.running());
  EXPECT_EQ(drive.position_mm(), rest_mm);
  EXPECT_EQ(drive.speed_mm_per_s(), 0);
  owner.signal(SIGKILL);
  owner.wait();
  expect_a_cold_start(drive);
}

TEST(StopChannel, StopsADriveThatIsNoLongerPolled) {
  // The drive's own watchdog takes 5 s here, so an earlier stop must come from the stop channel.
  const testing::TemporaryFolder folder;
  testing::VirtualRigOptions options{.start_mm = 3};
  std::string profile = *read_text_file(testing::drive_profile_path("virtual"), 1 << 20);
  const std::string good = "largest_time_s = 0.25";
  ASSERT_NE(profile.find(good), std::string::npos);
  options.profile = folder.write(
      "slow.toml", profile.replace(profile.find(good), good.size(), "largest_time_s = 5.0"));
  BenchRig drive("tcp", options);
  drive.make_ready();
  drive::Drive& owned = drive.drive();
  ASSERT_TRUE(owned.home());
  ASSERT_TRUE(wait_until([&] { return drive.mode() == "hold"; }));
  ASSERT_TRUE(owned.poll());
  StopChannel stop_channel(owned);
  ASSERT_TRUE(owned.move_to(100, kSpeed_mm_per_s));
  const double clean_s = drive.now_s();
  stop_channel.watch(true, Clock::now());
  ASSERT_TRUE(wait_until([&] { return drive.speed_mm_per_s() > 9.9; }));
  const double rested_s = drive.rested_s();
  EXPECT_GT(rested_s - clean_s, kStale_s);
  EXPECT_LT(rested_s - clean_s, kStale_s + 0.2);
  EXPECT_EQ(drive.mode(), "hold") << "the drive was stopped and did not trip";
  EXPECT_TRUE(stop_channel.consume_trip());
  EXPECT_FALSE(stop_channel.consume_trip());
}

}  // namespace
}  // namespace hydroprint::rig
