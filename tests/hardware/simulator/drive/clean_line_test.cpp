// A late reply is never mistaken for the reply to another request.
#include <thread>

#include "tests/hardware/simulator/drive/bench_rig.h"

namespace hydroprint::simulated_drive {
namespace {

using drive::Function;
using drive::Request;

// Two registers with different contents, read by requests of the same length.
const Request kMaker{1, Function::kReadHolding, 0x0000, 1, {}};
const Request kWatchdogTime{1, Function::kReadHolding, 0x0200, 1, {}};
constexpr std::uint16_t kMakerWord = 0x4850;
constexpr std::uint16_t kWatchdogWord = 250;

class CleanLine : public OnBothWires {};
HP_ON_BOTH_WIRES(CleanLine);

// Shows that the hazard exists, as the next test assumes: without silence after a timeout, the late
// word of one register is taken for that of another.
TEST(CleanLineSerial, WithoutSilenceALateReplyWouldBeTakenForAnotherOne) {
  BenchRig bench("rtu");
  const auto hasty = bench.other_link({milliseconds(500), milliseconds(100), milliseconds(0)});
  HP_ASSERT_OK(hasty->connect());
  bench.act("fault late 180ms");
  ASSERT_FALSE(hasty->transact(kMaker));
  const auto words = hasty->transact(kWatchdogTime);
  HP_ASSERT_OK(words);
  EXPECT_EQ((*words)[0], kMakerWord) << "the word of the other register";
}

// On RTU, only a request whose reply would look the same waits for the worst delay.
TEST(CleanLineSerial, OnlyAReadOfAsManyWordsWaitsForALateReply) {
  BenchRig bench("rtu");
  const auto link = bench.other_link({milliseconds(500), milliseconds(60), milliseconds(300)});
  HP_ASSERT_OK(link->connect());
  bench.act("fault drop");
  ASSERT_FALSE(link->transact(kMaker));
  const double other_s = seconds_of([&] {
    EXPECT_TRUE(link->transact({1, Function::kReadHolding, 0x0000, 2, {}}));
  });
  EXPECT_LT(other_s, 0.06);
  const double same_s = seconds_of([&] { EXPECT_TRUE(link->transact(kWatchdogTime)); });
  EXPECT_LT(same_s, 0.06) << "the drive has replied to a later request";
  bench.act("fault drop");
  ASSERT_FALSE(link->transact(kMaker));
  EXPECT_GT(seconds_of([&] { EXPECT_TRUE(link->transact(kWatchdogTime)); }), 0.29);
}

TEST(CleanLineSerial, ADriveThatForbidsItReceivesNothingDuringTheWorstDelay) {
  BenchRig bench("rtu");
  const auto link = bench.other_link(
      {milliseconds(500), milliseconds(60), milliseconds(300), {.silence_after_bad_reply = true}});
  HP_ASSERT_OK(link->connect());
  bench.act("fault drop");
  ASSERT_FALSE(link->transact(kMaker));
  EXPECT_GT(seconds_of([&] {
              EXPECT_TRUE(link->transact({1, Function::kReadHolding, 0x0000, 2, {}}));
            }),
            0.29);
}

TEST_P(CleanLine, ALateReplyIsNeverTakenForAnotherOne) {
  BenchRig bench(GetParam());
  const auto link = bench.other_link({milliseconds(500), milliseconds(60), milliseconds(200)});
  HP_ASSERT_OK(link->connect());
  for (const int late_ms : {70, 100, 130, 160, 190}) {
    bench.act("fault late " + std::to_string(late_ms) + "ms");
    ASSERT_FALSE(link->transact(kMaker));
    auto words = link->transact(kWatchdogTime);
    // Over TCP, the next request is sent at once, while the drive is still busy with the first.
    for (int i = 0; i < 3 && !words; ++i) words = link->transact(kWatchdogTime);
    HP_ASSERT_OK(words);
    EXPECT_EQ((*words)[0], kWatchdogWord) << late_ms;
  }
}

// A reply of another length is passed over, also if the drive is slower than stated in its profile.
TEST(CleanLineSerial, AReplyToAnotherRequestIsPassedOver) {
  BenchRig bench("rtu");
  const auto link = std::make_shared<drive::Link>(
      bench.endpoint(), drive::LinkTiming{milliseconds(500), milliseconds(100), milliseconds(0)});
  drive::Drive drive(bench.profile(), link);
  HP_ASSERT_OK(drive.connect());
  HP_ASSERT_OK(drive.poll());
  bench.act("fault late 180ms");
  ASSERT_FALSE(link->transact(kMaker));
  HP_ASSERT_OK(drive.poll());
  EXPECT_EQ(link->statistics().damaged_replies, 1U) << "the late reply";
}

TEST_P(CleanLine, WordsWithoutTheirMarkAreNotDecodedAsState) {
  BenchRig bench(GetParam());
  drive::DriveProfile profile = bench.profile();
  profile.blocks[0].mark.value = 0x1234;
  drive::Drive drive(profile, bench.drive().link());
  HP_ASSERT_OK(drive.connect());
  const auto state = drive.poll();
  ASSERT_FALSE(state);
  EXPECT_EQ(state.error().reason, ErrorReason::REPLY_INVALID);
  EXPECT_NE(state.error().message.find("0x0100"), std::string::npos) << state.error().message;
  EXPECT_EQ(drive.enable().error().reason, ErrorReason::RIG_OFFLINE);
}

TEST_P(CleanLine, EveryCallEndsWithinItsTimeLimit) {
  BenchRig bench(GetParam());
  bench.make_ready();
  bench.act("silent");
  // A read and its repetition.
  const double first_s = seconds_of([&] { EXPECT_FALSE(bench.drive().poll()); });
  EXPECT_LT(first_s, 2 * 0.1 + 0.05);
  // On a serial line, the second poll also waits until a late reply to the first can no longer be
  // taken for its own.
  const double second_s = seconds_of([&] { EXPECT_FALSE(bench.drive().poll()); });
  EXPECT_LT(second_s, 0.25 + 2 * 0.1 + 0.05);
}

}  // namespace
}  // namespace hydroprint::simulated_drive
