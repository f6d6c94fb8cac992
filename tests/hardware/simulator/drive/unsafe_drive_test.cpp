// Drives that must not be armed, and drives that do not match the profile.
#include "sim/base/input_file.h"
#include "tests/hardware/simulator/drive/bench_rig.h"
#include "tests/support/paths.h"

namespace hydroprint::simulated_drive {
namespace {

class UnsafeDrive : public OnBothWires {};
HP_ON_BOTH_WIRES(UnsafeDrive);

/// Returns the reason why connect() finds the drive unsafe. Expects that the drive can be read but
/// not moved.
Error held_against(BenchRig& bench) {
  const auto found = bench.drive().connect();
  if (!found || !found->unsafe) {
    ADD_FAILURE() << "the drive was not found to be unsafe";
    return {};
  }
  EXPECT_TRUE(bench.drive().poll());
  for (const Status& moved : {bench.drive().enable(), bench.drive().home(),
                              bench.drive().move_to(1, 5), bench.drive().jog(5)}) {
    EXPECT_FALSE(moved);
    if (!moved) {
      EXPECT_EQ(moved.error().reason, ErrorReason::DRIVE_CONFIG_UNSAFE);
    }
  }
  EXPECT_TRUE(bench.drive().stop());
  EXPECT_TRUE(bench.drive().disable());
  return *found->unsafe;
}

TEST_P(UnsafeDrive, WatchdogThatDoesNotStopIsUnsafe) {
  BenchRig bench(GetParam(), {.arguments = {"--watchdog-action", "0"}});
  const Error error = held_against(bench);
  EXPECT_EQ(error.reason, ErrorReason::DRIVE_CONFIG_UNSAFE);
  EXPECT_EQ(error.code, Code::kFailedPrecondition);
  EXPECT_NE(error.message.find("does not stop the axis"), std::string::npos) << error.message;
  EXPECT_NE(error.message.find("0x0201"), std::string::npos) << error.message;
}

TEST_P(UnsafeDrive, WatchdogThatIsOffIsUnsafe) {
  BenchRig bench(GetParam(), {.arguments = {"--watchdog-s", "0"}});
  EXPECT_NE(held_against(bench).message.find("is off"), std::string::npos);
}

TEST_P(UnsafeDrive, WatchdogThatWaitsTooLongIsUnsafe) {
  BenchRig bench(GetParam(), {.arguments = {"--watchdog-s", "0.3"}});
  const Error error = held_against(bench);
  EXPECT_NE(error.message.find("waits 0.3 s. Set it to at most 0.25 s"), std::string::npos)
      << error.message;
}

TEST_P(UnsafeDrive, GoodSettingsAreSafe) {
  BenchRig bench(GetParam(), {.arguments = {"--watchdog-s", "0.2"}});
  const auto found = bench.drive().connect();
  HP_ASSERT_OK(found);
  EXPECT_FALSE(found->unsafe);
  EXPECT_EQ(found->watchdog_s, 0.2);
  EXPECT_EQ(found->drive, "virtual drive");
}

TEST_P(UnsafeDrive, DriveWithoutAWatchdogIsNeverSafe) {
  BenchRig bench(GetParam());
  drive::DriveProfile profile = bench.profile();
  profile.watchdog.reset();
  drive::Drive drive(profile, bench.drive().link());
  const auto found = drive.connect();
  HP_ASSERT_OK(found);
  ASSERT_TRUE(found->unsafe);
  EXPECT_NE(found->unsafe->message.find("has no communication watchdog"), std::string::npos);
}

TEST_P(UnsafeDrive, AnotherDriveIsRefusedAndDisconnected) {
  const testing::TemporaryFolder folder;
  std::string text = *read_text_file(testing::drive_profile_path("virtual"), 1 << 20);
  const std::string maker = "value = 0x4850";
  text.replace(text.find(maker), maker.size(), "value = 0x4851");
  BenchRig bench(GetParam(), {.profile = folder.write("other.toml", text).string()});
  const auto ours = drive::read_drive_profile(testing::drive_profile_path("virtual"));
  HP_ASSERT_OK(ours);
  drive::Drive drive(*ours, bench.drive().link());
  const auto found = drive.connect();
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().reason, ErrorReason::DRIVE_CONFIG_UNSAFE);
  EXPECT_NE(found.error().message.find("holds 0x4851; 0x4850 is expected"), std::string::npos)
      << found.error().message;
  EXPECT_FALSE(drive.connected());
  EXPECT_FALSE(drive.poll());
  EXPECT_FALSE(drive.enable());
}

TEST_P(UnsafeDrive, AMissingRegisterMeansAnotherDrive) {
  BenchRig bench(GetParam());
  drive::DriveProfile profile = bench.profile();
  profile.identity[0].address = 0x7000;
  drive::Drive drive(profile, bench.drive().link());
  const auto found = drive.connect();
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().reason, ErrorReason::DRIVE_CONFIG_UNSAFE);
  EXPECT_NE(found.error().message.find("does not exist"), std::string::npos);
}

TEST_P(UnsafeDrive, AnotherUnitIdIsOffline) {
  BenchRig bench(GetParam());
  drive::DriveProfile profile = bench.profile();
  profile.unit = 2;
  drive::Drive drive(profile, bench.drive().link());
  const auto found = drive.connect();
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().reason, ErrorReason::RIG_OFFLINE);
}

}  // namespace
}  // namespace hydroprint::simulated_drive
