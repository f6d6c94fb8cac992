#include <gtest/gtest.h>

#include <map>

#include "hardware/rig/state.h"
#include "hardware/rig/state_names.h"
#include "tests/hardware/rig/state_walk.h"

namespace hydroprint::rig {
namespace {

using Kind = Event::Kind;

TEST(State, OnlyCommandsAreRefusedAndARefusalChangesNothing) {
  for_each_step([](const Condition& c, const Event& event, const Step& taken) {
    if (!taken.refusal) return;
    EXPECT_TRUE(is_command(event));
    EXPECT_EQ(taken.next, c);
    EXPECT_EQ(taken.actions, Actions{});
    EXPECT_NE(reason(*taken.refusal), ErrorReason{});
  });
}

TEST(State, ASecondMotionIsRefusedAndTheFirstContinues) {
  for_each_step([](const Condition& c, const Event& event, const Step& taken) {
    if (!is_start(event)) return;
    if (!in_motion(c.state) && c.state != State::kStopping) return;
    if (c.motion == Motion::kJog && event.kind == Kind::kJog) return;
    ASSERT_TRUE(taken.refusal);
    EXPECT_EQ(reason(*taken.refusal), ErrorReason::MOTION_IN_PROGRESS);
  });
}

TEST(State, ARefusalNamesTheRightReason) {
  for_each_step([](const Condition& c, const Event& event, const Step& taken) {
    if (!is_start(event)) return;
    const std::map<State, ErrorReason> reasons = {{State::kOffline, ErrorReason::RIG_OFFLINE},
                                                  {State::kDisarmed, ErrorReason::STATE_FORBIDS},
                                                  {State::kFault, ErrorReason::RIG_FAULTED},
                                                  {State::kEstopped, ErrorReason::STATE_FORBIDS}};
    if (reasons.contains(c.state)) {
      ASSERT_TRUE(taken.refusal);
      EXPECT_EQ(reason(*taken.refusal), reasons.at(c.state));
    }
    if (c.state == State::kUnhomed && event.kind != Kind::kHome) {
      ASSERT_TRUE(taken.refusal);
      EXPECT_EQ(reason(*taken.refusal), ErrorReason::RIG_NOT_HOMED);
    }
    EXPECT_FALSE(c.state == State::kIdle && taken.refusal);
  });
}

TEST(State, AnUnsafeDriveIsNeverArmed) {
  for_each_step([](const Condition& c, const Event& event, const Step& taken) {
    EXPECT_FALSE(taken.actions.enable && c.link != Link::kSafe);
    if (event.kind != Kind::kArm || c.state != State::kDisarmed || c.link == Link::kSafe) return;
    ASSERT_TRUE(taken.refusal);
    EXPECT_EQ(reason(*taken.refusal), ErrorReason::DRIVE_CONFIG_UNSAFE);
  });
}

}  // namespace
}  // namespace hydroprint::rig
