#include "hardware/rig/observe.h"

#include <gtest/gtest.h>

#include "hardware/rig/state_names.h"
#include "sim/base/input_file.h"
#include "tests/hardware/rig/axis.h"
#include "tests/hardware/rig/faulty_axis.h"
#include "tests/support/paths.h"

namespace hydroprint::rig {
namespace {

constexpr double kLate_s = 0.03;  // at most one poll later than possible

class FaultTable : public ::testing::TestWithParam<FaultRow> {};

TEST_P(FaultTable, EachFaultIsNoticedInTimeWithItsCause) {
  const FaultRow& row = GetParam();
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Noticed seen = play(row.doing, row.fault, seed);
    EXPECT_EQ(name(seen.cause), name(row.cause)) << "seed " << seed;
    const bool is_near = row.within_mm > 0 && seen.after_mm <= row.within_mm;
    EXPECT_TRUE(is_near || seen.after_s <= row.within_s + kLate_s)
        << "seed " << seed << ": " << seen.after_s << " s, " << seen.after_mm << " mm";
  }
}

INSTANTIATE_TEST_SUITE_P(All, FaultTable, ::testing::ValuesIn(fault_table()), [](const auto& row) {
  return std::to_string(row.index) + std::string(words(row.param.doing));
});

TEST(FaultTableText, IsThatOfTheReadme) {
  const auto text = read_text_file(testing::source_path("hardware/rig/README.md"), 1 << 20);
  ASSERT_TRUE(text);
  EXPECT_NE(text->find(fault_table_markdown()), std::string::npos)
      << "replace the table in hardware/rig/README.md by:\n"
      << fault_table_markdown();
}

TEST(Observe, GoodMotionsShowNoFault) {
  for (const Doing doing : {Doing::kUnhomed, Doing::kIdle, Doing::kHome, Doing::kJog, Doing::kMove,
                            Doing::kDip, Doing::kStopping}) {
    for (unsigned seed = 0; seed < 50; ++seed) {
      EXPECT_EQ(play(doing, AxisFault::kNone, seed).cause, Cause::kNone)
          << words(doing) << " seed " << seed;
    }
  }
  EXPECT_TRUE(play(Doing::kMove, AxisFault::kNone, 1).is_done);
  EXPECT_TRUE(play(Doing::kDip, AxisFault::kNone, 1).is_done);
  EXPECT_TRUE(play(Doing::kHome, AxisFault::kNone, 1).is_done);
}

TEST(Observe, WithoutAVelocityRegisterThePositionAloneShowsFaults) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto cause = [&](Doing doing, AxisFault fault) {
      return play(doing, fault, seed, false).cause;
    };
    for (const Doing doing : {Doing::kIdle, Doing::kHome, Doing::kJog, Doing::kMove, Doing::kDip}) {
      EXPECT_EQ(cause(doing, AxisFault::kNone), Cause::kNone) << words(doing) << " seed " << seed;
    }
    EXPECT_EQ(cause(Doing::kIdle, AxisFault::kZeroed), Cause::kUnexpectedMotion);
    EXPECT_EQ(cause(Doing::kIdle, AxisFault::kRunaway), Cause::kUnexpectedMotion);
    EXPECT_EQ(cause(Doing::kIdle, AxisFault::kDrift), Cause::kUnexpectedMotion);
    EXPECT_EQ(cause(Doing::kJog, AxisFault::kRunaway), Cause::kOverspeed);
    EXPECT_EQ(cause(Doing::kJog, AxisFault::kPositionFrozen), Cause::kFollowingError);
    EXPECT_EQ(cause(Doing::kMove, AxisFault::kPositionFrozen), Cause::kFollowingError);
  }
}

TEST(Observe, AJogMayChangeItsSpeedAndDirection) {
  const auto profile = test_profile();
  AxisOrder order{
      .state = State::kMoving, .motion = Motion::kJog, .speed_mm_per_s = 2, .entry_mm_per_s = 10};
  const auto after = [&](double t_s) {
    return order.since +
           std::chrono::duration_cast<TimePoint::duration>(std::chrono::duration<double>(t_s));
  };
  EXPECT_EQ(speed_bound_mm_per_s(profile, order, after(0)), 10);
  EXPECT_NEAR(speed_bound_mm_per_s(profile, order, after(0.14)), 6, 1e-6);
  EXPECT_EQ(speed_bound_mm_per_s(profile, order, after(0.5)), 2);
}

}  // namespace
}  // namespace hydroprint::rig
