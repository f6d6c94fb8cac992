#include "hardware/rig/state.h"

#include <gtest/gtest.h>

#include <deque>
#include <map>

#include "tests/hardware/rig/state_walk.h"

namespace hydroprint::rig {
namespace {

using Kind = Event::Kind;

bool anything(const Event&) { return true; }

Allowed all_but(Kind left_out) {
  return [left_out](const Event& event) { return event.kind != left_out; };
}

TEST(State, EveryStateCanBeReachedAndEveryReachableConditionMakesSense) {
  std::set<State> states;
  for (const Condition& c : reachable()) {
    states.insert(c.state);
    EXPECT_TRUE(makes_sense(c)) << ::testing::PrintToString(c);
  }
  EXPECT_EQ(states.size(), 9U);
  std::size_t sensible = 0;
  for (const Condition& c : all_conditions()) sensible += makes_sense(c) ? 1 : 0;
  std::cout << reachable().size() << " of " << sensible << " sensible conditions are reachable\n";
}

TEST(State, NoConditionOrEventStartsForbiddenMotion) {
  // Even from unreachable conditions, only safe commands are sent to the drive.
  const auto events = all_events();
  for (const Condition& c : all_conditions()) {
    for (const Event& event : events) {
      const Actions& actions = step(c, event).actions;
      ASSERT_FALSE(actions.start && !is_start(event));
      ASSERT_FALSE(actions.start && (c.state == State::kOffline || c.state == State::kDisarmed));
      ASSERT_FALSE(actions.enable && event.kind != Kind::kArm);
      ASSERT_FALSE(actions.start && (actions.stop || actions.disable || actions.enable));
    }
  }
}

TEST(State, AStepFromASensibleConditionLeadsToASensibleOne) {
  const auto events = all_events();
  for (const Condition& c : all_conditions()) {
    if (!makes_sense(c)) continue;
    for (const Event& event : events) {
      ASSERT_TRUE(makes_sense(step(c, event).next)) << text(c, event);
    }
  }
}

TEST(State, AStopIsNeverRefusedAlwaysSentAndEndsEveryMotion) {
  for_each_step([](const Condition&, const Event& event, const Step& taken) {
    if (event.kind != Kind::kStop) return;
    EXPECT_FALSE(taken.refusal);
    EXPECT_TRUE(taken.actions.stop);
    EXPECT_FALSE(in_motion(taken.next.state));
    EXPECT_NE(taken.next.pending, Pending::kArm);
  });
}

TEST(State, AMotionStartsOnlyByItsCommandFromIdleOrHomingFromUnhomed) {
  for_each_step([](const Condition& c, const Event& event, const Step& taken) {
    if (!taken.actions.start) {
      EXPECT_TRUE(in_motion(c.state) || !in_motion(taken.next.state));
      return;
    }
    EXPECT_TRUE(is_start(event));
    EXPECT_EQ(c.link, Link::kSafe);
    EXPECT_EQ(c.cause, Cause::kNone);
    const bool jogs_on = c.motion == Motion::kJog && event.kind == Kind::kJog;
    const bool homes = c.state == State::kUnhomed && event.kind == Kind::kHome;
    EXPECT_TRUE(c.state == State::kIdle || homes || jogs_on);
  });
}

TEST(State, BeforeArmingNothingMoves) {
  const auto disarmed =
      those([](const Condition& c) { return !is_armed(c.state) && c.pending == Pending::kNone; });
  reach(disarmed, all_but(Kind::kArm), [](const Condition&, const Event&, const Step& taken) {
    ASSERT_FALSE(taken.actions.start || taken.actions.enable);
    ASSERT_FALSE(in_motion(taken.next.state));
  });
}

TEST(State, BeforeHomingOnlyHomingMoves) {
  const auto unhomed = those([](const Condition& c) { return !c.homed && !in_motion(c.state); });
  reach(unhomed, all_but(Kind::kHome), [](const Condition&, const Event&, const Step& taken) {
    ASSERT_FALSE(taken.actions.start);
    ASSERT_FALSE(in_motion(taken.next.state));
    ASSERT_FALSE(taken.next.homed);
  });
}

TEST(State, OnlyACompletedHomingSetsHomed) {
  for_each_step([](const Condition& c, const Event& event, const Step& taken) {
    if (c.homed || !taken.next.homed) return;
    EXPECT_EQ(c.motion, Motion::kHome);
    EXPECT_EQ(event.kind, Kind::kMotionDone);
  });
}

TEST(State, AResetStartsNoMotionAndRequiresArmingAndHoming) {
  for_each_step([](const Condition& c, const Event& event, const Step& taken) {
    if (event.kind != Kind::kReset || taken.refusal) return;
    EXPECT_FALSE(taken.actions.start || taken.actions.enable);
    EXPECT_FALSE(in_motion(taken.next.state));
    EXPECT_EQ(taken.next.state, c.state);  // the drive must first show that the fault is cleared
  });
  for_each_step([](const Condition& c, const Event&, const Step& taken) {
    if (c.cause == Cause::kNone || taken.next.cause != Cause::kNone) return;
    EXPECT_EQ(taken.next.state, State::kDisarmed);
    EXPECT_EQ(c.pending, Pending::kReset);
    EXPECT_TRUE(taken.actions.disable);
  });
}

TEST(State, ArmingRequiresAResetAfterAFault) {
  const auto owing = those(
      [](const Condition& c) { return c.cause != Cause::kNone && c.pending == Pending::kNone; });
  reach(owing, all_but(Kind::kReset), [](const Condition&, const Event&, const Step& taken) {
    ASSERT_FALSE(taken.actions.start || taken.actions.enable);
  });
}

TEST(State, APressedButtonLatchesInEveryCase) {
  for_each_step([](const Condition& c, const Event& event, const Step& taken) {
    if (!has_bits(event) || !event.bits.button) return;
    // without a link, the button cannot be seen
    if (event.kind == Kind::kSample && c.link == Link::kNone) return;
    EXPECT_EQ(taken.next.state, State::kEstopped);
    EXPECT_TRUE(taken.actions.stop || c.cause == Cause::kStopButton);
  });
  const auto pressed = those([](const Condition& c) { return c.state == State::kEstopped; });
  const auto kept_pressed = [](const Event& e) { return !has_bits(e) || e.bits.button; };
  for (const Condition& c : reach(pressed, kept_pressed)) {
    // A reset may have been requested after the release was seen; the next poll reverts it.
    EXPECT_TRUE(c.state == State::kEstopped || c.state == State::kOffline);
    EXPECT_EQ(c.cause, Cause::kStopButton);
  }
}

TEST(State, ReleasingTheButtonDoesNotUnlatchIt) {
  const auto latched = those([](const Condition& c) {
    return c.cause == Cause::kStopButton && c.pending == Pending::kNone;
  });
  for (const Condition& c : reach(latched, all_but(Kind::kReset))) {
    EXPECT_TRUE(c.state == State::kEstopped || c.state == State::kOffline);
    EXPECT_EQ(c.cause, Cause::kStopButton);
  }
}

TEST(State, StoppingEndsAtStandstillOnly) {
  for_each_step([](const Condition& c, const Event& event, const Step& taken) {
    if (c.state != State::kStopping || taken.next.state == State::kStopping) return;
    if (taken.next.state == State::kEstopped) return;  // covered by the next test
    if (event.kind == Kind::kStandstillAssumed) {
      EXPECT_EQ(c.link, Link::kNone);
      EXPECT_EQ(taken.next.state, State::kOffline);
      return;
    }
    EXPECT_TRUE(has_bits(event));
    EXPECT_FALSE(event.bits.moving);
  });
}

TEST(State, FaultAndEstopAreLeftForDisarmedOnlyAtRestAndWithoutAlarm) {
  for_each_step([](const Condition& c, const Event& event, const Step& taken) {
    if (c.state != State::kFault && c.state != State::kEstopped) return;
    if (taken.next.state != State::kDisarmed) return;
    EXPECT_TRUE(has_bits(event));
    EXPECT_FALSE(event.bits.moving || event.bits.alarm || event.bits.button);
  });
}

TEST(State, AMotionEndsByBeingDoneOrByAStop) {
  for_each_step([](const Condition& c, const Event& event, const Step& taken) {
    if (!in_motion(c.state) || in_motion(taken.next.state)) return;
    if (event.kind == Kind::kMotionDone) {
      EXPECT_EQ(taken.next.state, State::kIdle);
      return;
    }
    EXPECT_TRUE(taken.actions.stop);
    EXPECT_TRUE(taken.next.state == State::kStopping || taken.next.state == State::kEstopped);
  });
}

TEST(State, AFaultInMotionStopsTheAxisAndIsKept) {
  for_each_step([](const Condition& c, const Event& event, const Step& taken) {
    if (!in_motion(c.state)) return;
    Cause cause = Cause::kNone;
    if (event.kind == Kind::kLost) cause = Cause::kLinkLost;
    if (event.kind == Kind::kFault) cause = event.cause;
    if (has_bits(event) && event.bits.button)
      cause = Cause::kStopButton;
    else if (has_bits(event) && c.homed && event.bits.limit)
      cause = Cause::kLimit;
    else if (has_bits(event) && event.bits.alarm)
      cause = Cause::kAlarm;
    else if (event.kind == Kind::kSeen && !event.safe)
      cause = Cause::kConfigUnsafe;
    else if (has_bits(event) && !event.bits.enabled)
      cause = Cause::kDropped;
    else if (has_bits(event) && c.homed && !event.bits.homed)
      cause = Cause::kDropped;
    EXPECT_EQ(taken.next.cause, cause);
    if (cause == Cause::kNone) return;
    EXPECT_TRUE(taken.actions.stop);
    EXPECT_FALSE(in_motion(taken.next.state));
    EXPECT_FALSE(taken.next.homed);
  });
}

TEST(State, AFaultObservedAtRestStopsTheAxisAndDiscardsTheHomePosition) {
  for_each_step([](const Condition& c, const Event& event, const Step& taken) {
    const bool at_rest = c.state == State::kUnhomed || c.state == State::kIdle;
    if (event.kind != Kind::kFault || !at_rest) return;
    EXPECT_EQ(taken.next.state, State::kStopping);
    EXPECT_EQ(taken.next.cause, event.cause);
    EXPECT_TRUE(taken.actions.stop);
    EXPECT_FALSE(taken.next.homed);
  });
}

TEST(State, AStopThatIsNotObeyedReplacesEveryOtherCause) {
  for_each_step([](const Condition& c, const Event& event, const Step& taken) {
    if (event.kind != Kind::kFault || c.state != State::kStopping) return;
    const bool is_loud = event.cause == Cause::kStopNotObeyed;
    EXPECT_EQ(taken.next.cause, is_loud ? Cause::kStopNotObeyed : c.cause);
    EXPECT_EQ(taken.next.state, State::kStopping);
  });
}

TEST(State, AnAxisThatMovesWithoutACommandIsStopped) {
  for_each_step([](const Condition& c, const Event& event, const Step& taken) {
    const bool moves = has_bits(event) && event.bits.moving && event.bits.enabled;
    if (!moves || in_motion(c.state) || c.pending == Pending::kArm) return;
    if (event.kind == Kind::kSample && c.link == Link::kNone) return;
    if (c.state == State::kEstopped || taken.next.state == State::kEstopped) return;
    EXPECT_EQ(taken.next.state, State::kStopping);
  });
}

TEST(State, AfterOfflineFaultAndDisarmingItIsNotHomed) {
  for (const Condition& c : reachable()) {
    const bool forgets = c.state == State::kOffline || c.state == State::kFault ||
                         c.state == State::kEstopped || c.state == State::kDisarmed;
    EXPECT_FALSE(forgets && c.homed) << ::testing::PrintToString(c);
  }
}

TEST(State, IdleCanBeReachedFromEveryCondition) {
  // Searches backwards from IDLE along the steps of a well-behaved drive.
  std::map<Condition, Conditions, ByFields> before;
  reach({Condition{}}, anything, [&](const Condition& c, const Event& event, const Step& taken) {
    if (event.bits.alarm || event.bits.button || event.bits.limit) return;
    before[taken.next].insert(c);
  });
  Conditions back = those([](const Condition& c) { return c.state == State::kIdle; });
  std::deque<Condition> open(back.begin(), back.end());
  while (!open.empty()) {
    const Condition c = open.front();
    open.pop_front();
    for (const Condition& earlier : before[c]) {
      if (back.insert(earlier).second) open.push_back(earlier);
    }
  }
  EXPECT_EQ(back.size(), reachable().size());
}

}  // namespace
}  // namespace hydroprint::rig
