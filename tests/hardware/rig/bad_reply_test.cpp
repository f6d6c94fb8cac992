// One lost, damaged, doubled or late reply to a poll ends no motion.
#include <gtest/gtest.h>

#include <cctype>
#include <thread>
#include <tuple>

#include "tests/hardware/rig/wired_rig.h"

namespace hydroprint::rig {
namespace {

using Outcome = MotionReport::Outcome;

constexpr const char* kBadReplies[] = {"fault drop 1", "fault wrong-crc 1", "fault double 1",
                                       "fault late 120ms 1"};

class OneBadReply : public simulated_drive::OnBothWires {};
HP_ON_BOTH_WIRES(OneBadReply);

/// Number of replies that were not what the request asked for.
std::uint64_t bad_replies(WiredRig& rig) {
  const drive::LinkStatistics link = rig->snapshot().link;
  return link.damaged_replies + link.unanswered_requests;
}

/// Makes the next reply a bad one, and expects that it occurs.
void damage(WiredRig& rig, const char* fault) {
  const std::uint64_t before = bad_replies(rig);
  rig.drive().act(fault);
  EXPECT_TRUE(wait_until([&] { return bad_replies(rig) > before; }, 2)) << fault;
}

/// A move and a dip with one bad reply each, per round and fault.
void move_and_dip(const char* wire, const std::vector<const char*>& faults, int rounds) {
  WiredRig rig(wire);
  rig.make_ready();
  for (int i = 0; i < rounds; ++i) {
    for (const char* fault : faults) {
      const std::uint64_t motion = rig.start_move(12, 4);
      damage(rig, fault);
      const MotionReport moved = rig.finish(motion);
      ASSERT_EQ(moved.outcome, Outcome::kDone) << fault << ", cause " << int(moved.cause);
      const Answer dip = rig->dip({{16, 8, 0.05}, {12, 8, 0}}).get();
      ASSERT_TRUE(dip) << dip.error().message;
      ASSERT_TRUE(wait_until([&] { return rig.drive().speed_mm_per_s() > 7.9; }));
      damage(rig, fault);
      const MotionReport dipped = rig.finish(*dip);
      ASSERT_EQ(dipped.outcome, Outcome::kDone) << fault << ", cause " << int(dipped.cause);
      ASSERT_EQ(rig.finish(rig.start_move(10, 8)).outcome, Outcome::kDone);
    }
  }
}

TEST_P(OneBadReply, EndsNoMoveAndNoDip) {
  move_and_dip(GetParam(), {std::begin(kBadReplies), std::end(kBadReplies)}, 1);
}

class ManyBadReplies : public ::testing::TestWithParam<std::tuple<const char*, const char*>> {};

TEST_P(ManyBadReplies, EndNoneOf250Motions) {
  const auto& [wire, fault] = GetParam();
  move_and_dip(wire, {fault}, 125);
}

INSTANTIATE_TEST_SUITE_P(Wire, ManyBadReplies,
                         ::testing::Combine(::testing::Values("tcp", "rtu"),
                                            ::testing::ValuesIn(kBadReplies)),
                         [](const auto& value) {
                           std::string name = std::get<0>(value.param);
                           for (const char c : std::string_view(std::get<1>(value.param)).substr(5))
                             name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
                           return name;
                         });

// A bad reply to a command of the jog is another matter: the command is not repeated. Its commands
// are far apart here, so that the bad reply is one to a poll.
TEST_P(OneBadReply, EndsNoJog) {
  WiredRig rig(GetParam());
  rig.make_ready();
  ASSERT_EQ(rig.finish(rig.start_move(50, 10)).outcome, Outcome::kDone);
  for (const char* fault : kBadReplies) {
    std::uint64_t motion = 0;
    const auto hold = [&](double seconds) {
      for (const auto begun = Clock::now(); seconds_since(begun) < seconds;) {
        const Answer answer = rig->jog(-5).get();
        ASSERT_TRUE(answer) << answer.error().message << " after " << fault;
        ASSERT_TRUE(motion == 0 || motion == *answer) << "a new jog after " << fault;
        motion = *answer;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
      }
    };
    hold(0.3);
    const std::uint64_t before = bad_replies(rig);
    rig.drive().act(fault);
    hold(0.5);
    EXPECT_GT(bad_replies(rig), before);
    EXPECT_EQ(rig.finish(motion).outcome, Outcome::kStopped) << fault;
  }
}

}  // namespace
}  // namespace hydroprint::rig
