#include "hardware/drive/profile.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sim/base/input_file.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::drive {
namespace {

std::string virtual_profile() {
  return *read_text_file(testing::drive_profile_path("virtual"), 1 << 20);
}

Result<DriveProfile> profile(const std::string& toml) {
  const testing::TemporaryFolder folder;
  return read_drive_profile(folder.write("drive.toml", toml));
}

/// The virtual drive's profile with `from`, which must occur, replaced by `to`.
std::string changed(const std::string& from, const std::string& to) {
  std::string text = virtual_profile();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(DriveProfile, VirtualDriveIsReadCorrectly) {
  const auto read = profile(virtual_profile());
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->name, "virtual drive");
  EXPECT_EQ(read->unit, 1);
  EXPECT_EQ(read->max_speed_mm_per_s, 20);
  EXPECT_EQ(read->response_timeout, std::chrono::milliseconds(100));
  EXPECT_EQ(read->homing_speed_mm_per_s, 10);
  EXPECT_TRUE(read->velocity);
  EXPECT_FALSE(read->bus.echo || read->bus.unit_any || read->bus.rtu_over_tcp);
  ASSERT_EQ(read->identity.size(), 2U);
  EXPECT_EQ(read->identity[1].mask, 0xff00);
  ASSERT_EQ(read->blocks.size(), 1U);
  EXPECT_EQ(read->blocks[0].count, 9);
  EXPECT_EQ(read->blocks[0].mark.value, 0xa55a);
  EXPECT_EQ(read->position.address, 0x0103);
  EXPECT_TRUE(read->position.format.is_signed);
  ASSERT_TRUE(read->bit(StatusBit::kStopInput));
  EXPECT_TRUE(read->bit(StatusBit::kStopInput)->inverted);
  ASSERT_EQ(read->command(Command::kMove).size(), 1U);
  EXPECT_EQ(read->command(Command::kMove)[0].values.size(), 4U);
  ASSERT_TRUE(read->watchdog);
  EXPECT_EQ(read->watchdog->stopping, std::vector<std::uint16_t>({1}));
  EXPECT_EQ(read->alarms.at(0x30).text.substr(0, 21), "communication timeout");
}

TEST(DriveProfile, StoppingDistanceMatchesTheNotes) {
  DriveProfile drive;
  drive.stopping_deceleration_mm_per_s2 = 200;
  // Daemon notes, section 3.6: at 20 mm/s, 15 mm within 0.25 s + 0.5 s, and 1 mm of braking at
  // 200 mm/s^2.
  EXPECT_DOUBLE_EQ(stopping_distance_mm(drive, 20, 0.75), 16);
  EXPECT_DOUBLE_EQ(stopping_distance_mm(drive, -20, 0.75), 16);
}

struct Wrong {
  const char* from;
  const char* to;
  const char* what;  ///< required text of the message, besides file and line
};

class WrongProfile : public ::testing::TestWithParam<Wrong> {};

TEST_P(WrongProfile, IsRefusedWithFileLineAndRemedy) {
  const Wrong& wrong = GetParam();
  const std::string text = changed(wrong.from, wrong.to);
  const auto read = profile(text);
  ASSERT_FALSE(read);
  const std::string& message = read.error().message;
  EXPECT_NE(message.find("drive.toml: line "), std::string::npos) << message;
  EXPECT_NE(message.find(wrong.what), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    All, WrongProfile,
    ::testing::Values(
        Wrong{"unit = 1 ", "unit = 0 ",
              "unit is not a whole number in range. Give a whole number from 1 to 247"},
        Wrong{"unit = 1 ", "unit = \"1\" ", "unit is not a whole number"},
        Wrong{"unit = 1 ", "units = 1 ", "units is not a known key here. Use "},
        Wrong{"name = \"virtual drive\"", "", "name is missing. Add it"},
        Wrong{"max_speed_mm_per_s = 20.0", "max_speed_mm_per_s = 0", "motion.max_speed_mm_per_s"},
        Wrong{"max_speed_mm_per_s = 20.0", "max_speed_mm_per_s = nan", "motion.max_speed_mm_per_s"},
        Wrong{"jog_dead_man_s = 0.2", "jog_dead_man_s = 0.02",
              "Set jog_refresh_s to jog_dead_man_s or less"},
        Wrong{"worst_delay_s = 0.25", "worst_delay_s = \"long\"", "timing.worst_delay_s"},
        Wrong{"address = 0x0001", "address = 0x10000", "identity.address"},
        Wrong{"mask = 0xff00", "mask = 0xff00\nvalue2 = 1", "not a known key"},
        Wrong{"value = 0x0100\nmask", "value = 0x0101\nmask", "omits bits of the value"},
        Wrong{"count = 9", "count = 126", "block.count"},
        Wrong{"count = 9", "count = 8", "demand is not in any block"},
        Wrong{"address = 0x0100, value", "address = 0x0109, value", "is outside its block"},
        Wrong{"words = 2                     #", "words = 3 #", "position.words"},
        Wrong{"counts_per_mm = 10000.0       #", "counts_per_mm = 0 #", "position.counts_per_mm"},
        Wrong{"space = \"input\"\naddress = 0x0103", "space = \"coil\"\naddress = 0x0103",
              "\"holding\", \"input\""},
        Wrong{"alarm = { space", "alarms = { space", "status.alarm is missing"},
        Wrong{"bit = 2 }", "bit = 16 }", "status.moving.bit"},
        Wrong{"[4, \"position\", \"speed\"", "[4, \"position\", \"spede\"", "commands.move.values"},
        Wrong{"values = [7]", "values = []", "commands.stop.values"},
        Wrong{"stop = [{ address = 0x0300, values = [7] }]", "stop = []", "commands.stop is empty"},
        Wrong{"largest_time_s = 0.25", "largest_time_s = 0", "watchdog.largest_time_s"},
        Wrong{"stopping_actions = [1]", "stopping_actions = [\"halt\"]",
              "watchdog.stopping_actions"},
        Wrong{"code = 0x20", "code = 0x10", "is used by two alarms"},
        Wrong{"response_timeout_s = 0.1 ", "response_timeout_s = 0.13 ",
              "may take 0.21 s (response_timeout_s + 0.08 s), which must be less than 0.2 s, "
              "motion.jog_dead_man_s"},
        Wrong{"response_timeout_s = 0.1 ", "response_timeout_s = 0.17 ",
              "less than 0.25 s, after which the link counts as lost. Lower response_timeout_s"},
        Wrong{"largest_time_s = 0.25", "largest_time_s = 0.18",
              "less than 0.18 s, watchdog.largest_time_s"},
        Wrong{"silence_after_bad_reply = false", "silence_after_bad_reply = true",
              "may take 0.43 s (response_timeout_s + worst_delay_s + 0.08 s)"},
        Wrong{"silence_after_bad_reply = false", "silence_after_bad_reply = 1",
              "timing.silence_after_bad_reply is not a boolean"},
        Wrong{"homing_speed_mm_per_s = 10.0", "homing_speed_mm_per_s = 20.5",
              "motion.homing_speed_mm_per_s is higher than max_speed_mm_per_s"},
        Wrong{"homing_speed_mm_per_s = 10.0", "homing_speed_mm_per_s = nan",
              "motion.homing_speed_mm_per_s is not a number in range"},
        Wrong{"echo = false", "echo = \"yes\"", "echo is not a boolean"},
        Wrong{"[motion]", "[motion", "Correct the TOML there"}));

TEST(DriveProfile, KeysOfUnusualBusesAreRead) {
  const auto read = profile("unit_any = true\nrtu_over_tcp = true\necho = true\n" + [] {
    std::string text = virtual_profile();
    for (const char* key : {"\nunit_any", "\nrtu_over_tcp", "\necho"}) {
      text.insert(text.find(key) + 1, "# ");
    }
    return text;
  }());
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(read->bus.echo && read->bus.unit_any && read->bus.rtu_over_tcp);
}

TEST(DriveProfile, TheVelocityAndTheHomingSpeedMayBeAbsent) {
  std::string text = changed("homing_speed_mm_per_s", "# homing_speed_mm_per_s");
  const std::size_t begin = text.find("[velocity]");
  text.erase(begin, text.find("[demand]") - begin);
  const auto read = profile(text);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_FALSE(read->velocity);
  EXPECT_FALSE(read->homing_speed_mm_per_s);
}

TEST(DriveProfile, ABudgetThatHoldsIsAccepted) {
  EXPECT_TRUE(profile(changed("response_timeout_s = 0.1 ", "response_timeout_s = 0.119 ")));
  std::string silent = changed("silence_after_bad_reply = false", "silence_after_bad_reply = true");
  const std::string delay = "worst_delay_s = 0.25 ";
  silent.replace(silent.find(delay), delay.size(), "worst_delay_s = 0.019 ");
  EXPECT_TRUE(profile(silent));
}

TEST(DriveProfile, ABlockThatCannotBeReadAgainInOtherPartsIsRefused) {
  // 9 words halve into 3 + 6 or, as numbers must stay whole, 1 + 8 or 2 + 7.
  std::string more;
  for (const int count : {3, 1 + 7, 7}) {
    more += "\n[[block]]\nspace = \"input\"\naddress = " + std::to_string(1000 + 100 * count) +
            "\ncount = " + std::to_string(count) +
            "\nmark = { address = " + std::to_string(1000 + 100 * count) + ", value = 1 }\n";
  }
  const auto read = profile(virtual_profile() + more);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("block at 0x0100 cannot be read again"), std::string::npos)
      << read.error().message;
}

TEST(DriveProfile, BlocksOfEqualLengthAreRefused) {
  const auto read = profile(virtual_profile() +
                            "\n[[block]]\nspace = \"input\"\naddress = 0x0400\ncount = 9\n"
                            "mark = { address = 0x0400, value = 1 }\n");
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("late replies could be confused"), std::string::npos);
}

TEST(DriveProfile, AnErrorIsOneLineForAnyContent) {
  for (const std::string& text :
       {"\"a\\nb\" = 1\n" + virtual_profile(), changed("[timing]", "[timing]\n\"x\\u001by\" = 1"),
        std::string("name = \"\\q\n")}) {
    const auto read = profile(text);
    ASSERT_FALSE(read);
    EXPECT_TRUE(std::all_of(read.error().message.begin(), read.error().message.end(),
                            [](unsigned char c) { return c >= ' ' && c != 0x7f; }))
        << read.error().message;
  }
}

TEST(DriveProfile, ErrorsNameTheLineOfTheKey) {
  const std::string text = changed("bit = 2 }", "bit = 16 }");
  const auto line =
      1 + std::count(text.begin(),
                     text.begin() + static_cast<std::ptrdiff_t>(text.find("bit = 16")), '\n');
  EXPECT_NE(profile(text).error().message.find("line " + std::to_string(line) + ":"),
            std::string::npos);
}

TEST(DriveProfile, ShippedProfilesAreValidAndSayWhetherTheyWereTried) {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(testing::source_path("hardware/profiles"))) {
    const auto read = read_drive_profile(entry.path());
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_FALSE(read->tried_on_hardware);
    ++count;
  }
  EXPECT_EQ(count, 3);
}

}  // namespace
}  // namespace hydroprint::drive
