#include "hardware/drive/late_replies.h"

#include <gtest/gtest.h>

namespace hydroprint::drive {
namespace {

using TimePoint = LateReplies::TimePoint;

Request read_of(std::uint16_t address, std::uint16_t count) {
  return {1, Function::kReadInput, address, count, {}};
}
Request write_of(std::uint16_t address, std::uint16_t value) {
  return {1, Function::kWriteOne, address, 0, {value}};
}

TEST(LateReplies, RepliesOfEqualLengthLookAlikeWhateverTheirRegisters) {
  EXPECT_TRUE(replies_look_alike(read_of(1, 9), read_of(50, 9)));
  EXPECT_FALSE(replies_look_alike(read_of(1, 9), read_of(1, 8)));
  EXPECT_FALSE(replies_look_alike(read_of(1, 9), {1, Function::kReadHolding, 1, 9, {}}));
  EXPECT_TRUE(replies_look_alike(write_of(3, 7), write_of(3, 7)));
  EXPECT_FALSE(replies_look_alike(write_of(3, 7), write_of(3, 8)));
  const Request two{1, Function::kWriteMany, 3, 0, {1, 2}};
  EXPECT_TRUE(replies_look_alike(two, {1, Function::kWriteMany, 3, 0, {8, 9}}))
      << "the reply to function 16 holds no values";
}

TEST(LateReplies, OnlyARequestWithTheSameReplyWaits) {
  const TimePoint until = std::chrono::steady_clock::now() + std::chrono::hours(1);
  LateReplies late;
  late.add(read_of(1, 9), until);
  EXPECT_EQ(late.clear_for(read_of(50, 9)), until);
  EXPECT_EQ(late.clear_for(read_of(1, 3)), TimePoint{});
  EXPECT_TRUE(late.expects_any(until - std::chrono::seconds(1)));
  EXPECT_FALSE(late.expects_any(until));
  late.clear();
  EXPECT_FALSE(late.expects_any(until - std::chrono::seconds(1)));
  EXPECT_EQ(late.clear_for(read_of(1, 9)), TimePoint{});
}

TEST(LateReplies, OneThatWasPassedOverIsNotWaitedForButRemembered) {
  const TimePoint until = std::chrono::steady_clock::now() + std::chrono::hours(1);
  const TimePoint before = until - std::chrono::seconds(1);
  LateReplies late;
  late.add(read_of(1, 9), until);
  late.pass_over();
  EXPECT_EQ(late.clear_for(read_of(1, 9)), TimePoint{});
  EXPECT_FALSE(late.expects_any(before));
  EXPECT_TRUE(late.may_be_confused(read_of(1, 9), before));
  EXPECT_FALSE(late.may_be_confused(read_of(1, 5), before));
  EXPECT_FALSE(late.may_be_confused(read_of(1, 9), until));
  late.add(read_of(1, 9), until);
  EXPECT_EQ(late.clear_for(read_of(1, 9)), until) << "missing again";
}

TEST(LateReplies, TheLatestOfEqualRequestsCounts) {
  const TimePoint until = std::chrono::steady_clock::now() + std::chrono::hours(1);
  LateReplies late;
  late.add(read_of(1, 9), until);
  late.add(read_of(1, 3), until);
  late.add(read_of(1, 9), until + std::chrono::seconds(1));
  EXPECT_EQ(late.clear_for(read_of(1, 9)), until + std::chrono::seconds(1));
  EXPECT_EQ(late.clear_for(read_of(1, 3)), until);
}

}  // namespace
}  // namespace hydroprint::drive
