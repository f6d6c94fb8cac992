// One lost, damaged, doubled or late reply does not end a poll.
#include "hardware/drive/link_budget.h"
#include "tests/hardware/simulator/drive/bench_rig.h"
#include "tests/support/campaign.h"

namespace hydroprint::simulated_drive {
namespace {

constexpr const char* kBadReplies[] = {"fault drop", "fault wrong-crc", "fault double",
                                       "fault late 120ms", "fault overtaken"};

class BadReply : public OnBothWires {};
HP_ON_BOTH_WIRES(BadReply);

/// Lets the next reply be bad, and no other one within the time in which it can still arrive.
void strike(BenchRig& bench, const char* fault) {
  if (std::string(fault) == "fault overtaken") {
    const auto end = Clock::now() + bench.profile().worst_delay;
    bench.poll_until([end](const drive::DriveState&) { return Clock::now() > end; });
  }
  bench.act(fault);
}

/// Polls while the axis moves, and checks that the position is that of this poll. Returns the
/// duration.
double poll_checked(BenchRig& bench, const char* fault) {
  const double before_mm = bench.position_mm() - 50;
  const auto begin = Clock::now();
  const auto state = bench.drive().poll();
  const double duration_s = testing::seconds_since(begin);
  const double after_mm = bench.position_mm() - 50;
  EXPECT_TRUE(state) << fault << ": " << state.error().message;
  if (!state) return duration_s;
  EXPECT_GE(state->position_mm, std::min(before_mm, after_mm) - 0.01) << fault;
  EXPECT_LE(state->position_mm, std::max(before_mm, after_mm) + 0.01) << fault;
  return duration_s;
}

/// Polls with each kind of bad reply in turn while the axis moves.
void poll_with_bad_replies(const char* wire, int rounds) {
  BenchRig bench(wire, {.start_mm = 50});
  bench.make_ready();
  const double budget_s = drive::recovery_time_s(bench.profile());
  double longest_s = 0;
  for (const char* fault : kBadReplies) {
    double shortest_s = 1;  // of equal polls, the one that the machine delayed least
    for (int round = 0; round < rounds; ++round) {
      HP_ASSERT_OK(bench.drive().move_to(round % 2 == 0 ? 20 : 0, 10));
      strike(bench, fault);
      shortest_s = std::min(shortest_s, poll_checked(bench, fault));
      // The next reads are those that a doubled or late reply could be taken for.
      poll_checked(bench, fault);
      poll_checked(bench, fault);
      EXPECT_EQ(bench.truth().at("alarm_code"), 0) << "the watchdog must not act";
    }
    longest_s = std::max(longest_s, shortest_s);
  }
  EXPECT_LT(longest_s + drive::kLongestPollPeriod_s, budget_s);
  std::cout << "longest poll " << longest_s << " s, budget " << budget_s << " s\n";
}

TEST_P(BadReply, DoesNotEndAPoll) { poll_with_bad_replies(GetParam(), 5); }

TEST_P(BadReply, DoesNotEndAPollAThousandTimes) { poll_with_bad_replies(GetParam(), 250); }

TEST_P(BadReply, IsCounted) {
  BenchRig bench(GetParam());
  bench.make_ready();
  const auto before = bench.drive().link()->statistics();
  for (const char* fault : kBadReplies) {
    strike(bench, fault);
    HP_ASSERT_OK(bench.drive().poll());
  }
  HP_ASSERT_OK(bench.drive().poll());
  const auto after = bench.drive().link()->statistics();
  EXPECT_EQ(after.unanswered_requests - before.unanswered_requests,
            std::string(GetParam()) == "rtu" ? 3U : 4U)
      << "lost, late, overtaken and, over TCP, that with another transaction id";
  EXPECT_EQ(after.retried_reads - before.retried_reads, 4U);
  EXPECT_EQ(after.damaged_replies - before.damaged_replies, 4U)
      << "damaged, the second copy, and both late ones";
}

TEST_P(BadReply, TimesOfRepliesAreCountedInBuckets) {
  BenchRig bench(GetParam());
  bench.make_ready();
  const auto before = bench.drive().link()->statistics();
  bench.act("fault late 60ms");
  HP_ASSERT_OK(bench.drive().poll());
  const auto after = bench.drive().link()->statistics();
  EXPECT_EQ(after.replies[6] - before.replies[6], 1U) << "50 to 100 ms";
  EXPECT_NEAR(after.reply_time_sum_s - before.reply_time_sum_s, 0.065, 0.02);
}

}  // namespace
}  // namespace hydroprint::simulated_drive
