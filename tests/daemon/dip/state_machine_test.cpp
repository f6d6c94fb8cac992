// Explores the whole procedure: every event in every reachable state.
#include "daemon/dip/state_machine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace hydroprint::dip {
namespace {

using Is = Event::Kind;

// Time between two events: shorter than some clocks and longer than others.
constexpr double kStep_s = 30;
const Clocks kClocks{60, 20, 60, false};
constexpr int kEvents = static_cast<int>(Is::kShutdown) + 1;

/// Every event at this time; the confirmation once for every step.
std::vector<Event> all_events(double time_s) {
  std::vector<Event> out;
  for (int kind = 0; kind < kEvents; ++kind) {
    const auto is = static_cast<Is>(kind);
    for (int step = 1; step <= (is == Is::kConfirm ? kSteps : 1); ++step) {
      out.push_back({is, time_s, static_cast<Step>(step), 40});
    }
  }
  return out;
}

/// Whether two states are equal except for times. Only the compared fields determine what may
/// happen next.
bool alike(const Stand& a, const Stand& b) {
  return a.step == b.step && a.ending == b.ending && a.over == b.over && a.late == b.late &&
         a.loaded_mm == b.loaded_mm && a.contact_mm == b.contact_mm &&
         a.sprayed_s.has_value() == b.sprayed_s.has_value();
}

struct Change {
  Stand before;
  Event event;
  Outcome outcome;
};

/// All transitions from all reachable states, with events before and after the end of the state's
/// clock.
std::vector<Change> all_changes(const Clocks& clocks) {
  std::vector<Stand> known{{}};
  std::vector<Change> changes;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const Stand stand = known[i];
    for (const double wait_s : {1.0, kStep_s, 1000.0}) {
      for (const Event& event : all_events(stand.since_s + wait_s)) {
        const Outcome outcome = proceed(stand, event, clocks);
        changes.push_back({stand, event, outcome});
        const auto same = [&](const Stand& other) { return alike(other, outcome.next); };
        if (std::none_of(known.begin(), known.end(), same)) known.push_back(outcome.next);
      }
    }
  }
  return changes;
}

std::string shown(const Change& change) {
  return std::string(name(change.before.step)) + " " + std::string(name(change.before.ending)) +
         " event " + std::to_string(static_cast<int>(change.event.kind)) + " -> " +
         std::string(name(change.outcome.next.step)) + " " +
         std::string(name(change.outcome.next.ending));
}

class DipTransitions : public ::testing::TestWithParam<bool> {
 protected:
  static Clocks clocks() {
    Clocks out = kClocks;
    out.skip = GetParam();
    return out;
  }
};
INSTANTIATE_TEST_SUITE_P(Skip, DipTransitions, ::testing::Bool(),
                         [](const auto& skip) { return skip.param ? "unattended" : "guided"; });

TEST_P(DipTransitions, ReachesEveryStepAndEveryEnding) {
  std::vector<bool> steps(kSteps + 1), endings(5);
  for (const Change& change : all_changes(clocks())) {
    steps[static_cast<std::size_t>(change.outcome.next.step)] = true;
    endings[static_cast<std::size_t>(change.outcome.next.ending)] = true;
  }
  EXPECT_EQ(std::count(steps.begin(), steps.end(), true), kSteps);
  EXPECT_EQ(std::count(endings.begin(), endings.end(), true), 5);
}

TEST_P(DipTransitions, GoesToTheNextStepOrStays) {
  for (const Change& change : all_changes(clocks())) {
    const int before = static_cast<int>(change.before.step);
    const int next = static_cast<int>(change.outcome.next.step);
    EXPECT_TRUE(next == before || next == before + 1) << shown(change);
  }
}

TEST_P(DipTransitions, LeavesAStepOnlyByItsOwnEvent) {
  for (const Change& change : all_changes(clocks())) {
    if (change.outcome.next.step == change.before.step) continue;
    const Step step = change.before.step;
    const Is is = change.event.kind;
    const bool confirmed = is == Is::kConfirm && change.event.step == step;
    const double elapsed_s = change.event.time_s - change.before.since_s;
    switch (awaits(step)) {
      case Awaits::kOperator:
        EXPECT_TRUE(confirmed || (clocks().skip && is == Is::kTick)) << shown(change);
        break;
      case Awaits::kClock:
        EXPECT_EQ(is, Is::kTick) << shown(change);
        EXPECT_TRUE(clocks().skip || elapsed_s >= (step == Step::kSoak ? 60 : 20)) << shown(change);
        break;
      case Awaits::kMotion:
        EXPECT_TRUE(is == Is::kMotionDone || is == Is::kAtDepth || is == Is::kRising)
            << shown(change);
        break;
    }
  }
}

TEST_P(DipTransitions, StartsOnlyItsTwoMotions) {
  for (const Change& change : all_changes(clocks())) {
    const Step step = change.before.step;
    const Step next = change.outcome.next.step;
    EXPECT_EQ(change.outcome.action == Action::kRise,
              step == Step::kFindContact && next == Step::kClear)
        << shown(change);
    EXPECT_EQ(change.outcome.action == Action::kDip,
              step == Step::kStartDip && next == Step::kDescend)
        << shown(change);
  }
}

TEST_P(DipTransitions, DecidedEndingIsFinalAndStartsNoMotion) {
  for (const Change& change : all_changes(clocks())) {
    if (change.before.ending == Ending::kNone) continue;
    const Stand& next = change.outcome.next;
    EXPECT_EQ(next.ending, change.before.ending) << shown(change);
    EXPECT_EQ(next.step, change.before.step) << shown(change);
    EXPECT_TRUE(change.outcome.action == Action::kNone || change.outcome.action == Action::kStop)
        << shown(change);
    EXPECT_FALSE(change.before.over && !next.over) << shown(change);
  }
}

TEST_P(DipTransitions, IsOverOnlyWhenTheAxisIsAtRest) {
  for (const Change& change : all_changes(clocks())) {
    if (change.before.over || !change.outcome.next.over) continue;
    EXPECT_NE(change.outcome.next.ending, Ending::kNone) << shown(change);
    if (awaits(change.before.step) != Awaits::kMotion) continue;
    EXPECT_TRUE(change.event.kind == Is::kAtRest || change.event.kind == Is::kOrderRefused)
        << shown(change);
  }
}

TEST_P(DipTransitions, CancelAndShutdownEndTheDipAndStopAMotion) {
  for (const Change& change : all_changes(clocks())) {
    const Is is = change.event.kind;
    if ((is != Is::kCancel && is != Is::kShutdown) || change.before.ending != Ending::kNone) {
      continue;
    }
    const bool moves = awaits(change.before.step) == Awaits::kMotion;
    EXPECT_EQ(change.outcome.next.ending,
              is == Is::kCancel ? Ending::kCancelled : Ending::kInterrupted);
    EXPECT_EQ(change.outcome.action, moves ? Action::kStop : Action::kNone) << shown(change);
    EXPECT_EQ(change.outcome.next.over, !moves) << shown(change);
  }
}

TEST_P(DipTransitions, ConfirmsOnlyTheCurrentStepOrEarlierOnes) {
  for (const Change& change : all_changes(clocks())) {
    if (change.event.kind != Is::kConfirm) continue;
    const Stand& before = change.before;
    const bool past = change.event.step < before.step;
    const bool waits = change.event.step == before.step && before.ending == Ending::kNone &&
                       awaits(before.step) == Awaits::kOperator;
    EXPECT_EQ(change.outcome.refused, !past && !waits) << shown(change);
    EXPECT_TRUE(waits || change.outcome.next == before) << shown(change);
  }
}

TEST_P(DipTransitions, LostReferenceEndsTheDipAfterFirstContact) {
  for (const Change& change : all_changes(clocks())) {
    if (change.event.kind != Is::kPlaceLost || change.before.ending != Ending::kNone) continue;
    const bool at_rest = awaits(change.before.step) != Awaits::kMotion;
    const bool ends = at_rest && has_the_rig(change.before.step);
    EXPECT_EQ(change.outcome.next.ending == Ending::kFailed, ends) << shown(change);
  }
}

TEST_P(DipTransitions, KnowsLoadContactAndSprayAfterwards) {
  for (const Change& change : all_changes(clocks())) {
    const Stand& next = change.outcome.next;
    EXPECT_EQ(next.loaded_mm.has_value(), next.step > Step::kLoadObject) << shown(change);
    EXPECT_EQ(next.contact_mm.has_value(), next.step > Step::kFindContact) << shown(change);
    EXPECT_EQ(next.sprayed_s.has_value(), next.step > Step::kSprayActivator) << shown(change);
    EXPECT_FALSE(next.late && next.step < Step::kStartDip) << shown(change);
  }
}

/// A dip into which a test feeds events; returns the resulting actions.
class Walk {
 public:
  Action feed(Is is, double time_s, double position_mm = 0) {
    const Outcome outcome = proceed(stand, {is, time_s, stand.step, position_mm}, kClocks);
    EXPECT_FALSE(outcome.refused);
    stand = outcome.next;
    return outcome.action;
  }
  void to_start_of_the_dip() {
    for (const double position_mm : {0.0, 3.0, 40.0}) feed(Is::kConfirm, 10, position_mm);
    feed(Is::kMotionDone, 14);
    feed(Is::kConfirm, 20);
    feed(Is::kTick, 80);
    feed(Is::kConfirm, 100);
    feed(Is::kTick, 120);
  }
  Stand stand;
};

TEST(Procedure, GuidesThroughAWholeDip) {
  Walk dip;
  dip.feed(Is::kConfirm, 1);
  dip.feed(Is::kConfirm, 2, 3.5);
  EXPECT_EQ(dip.stand.loaded_mm, 3.5);
  EXPECT_EQ(dip.feed(Is::kConfirm, 3, 40), Action::kRise);
  EXPECT_EQ(dip.stand.contact_mm, 40);
  dip.feed(Is::kMotionDone, 7);
  EXPECT_EQ(dip.stand.step, Step::kLayFilm);
  dip.feed(Is::kConfirm, 10);
  dip.feed(Is::kTick, 69.9);
  EXPECT_EQ(dip.stand.step, Step::kSoak);
  dip.feed(Is::kTick, 70);
  EXPECT_EQ(dip.stand.step, Step::kSprayActivator);
  dip.feed(Is::kConfirm, 75);
  dip.feed(Is::kTick, 94.9);
  EXPECT_EQ(dip.stand.step, Step::kActivate);
  dip.feed(Is::kTick, 95);
  EXPECT_EQ(dip.stand.step, Step::kStartDip);
  EXPECT_EQ(dip.feed(Is::kConfirm, 96), Action::kDip);
  dip.feed(Is::kAtDepth, 104);
  EXPECT_EQ(dip.stand.step, Step::kHold);
  dip.feed(Is::kRising, 106);
  EXPECT_EQ(dip.stand.step, Step::kRetract);
  dip.feed(Is::kMotionDone, 114);
  EXPECT_EQ(dip.stand.ending, Ending::kSucceeded);
  dip.feed(Is::kAtRest, 114);
  EXPECT_TRUE(dip.stand.over);
}

TEST(Procedure, LateFilmCausesAWarningAndNoRefusal) {
  Walk dip;
  dip.to_start_of_the_dip();
  dip.feed(Is::kTick, 180);
  EXPECT_FALSE(dip.stand.late) << "sprayed at 100 s, then 20 s of waiting and a window of 60 s";
  dip.feed(Is::kTick, 180.1);
  EXPECT_TRUE(dip.stand.late);
  EXPECT_EQ(dip.feed(Is::kConfirm, 400), Action::kDip);
  EXPECT_TRUE(dip.stand.late);
}

TEST(Procedure, StopCancelsInMotionAndDoesNothingAtRest) {
  Walk dip;
  dip.to_start_of_the_dip();
  dip.feed(Is::kMotionStopped, 130);
  EXPECT_EQ(dip.stand.ending, Ending::kNone);
  dip.feed(Is::kConfirm, 140);
  dip.feed(Is::kMotionStopped, 141);
  EXPECT_EQ(dip.stand.ending, Ending::kCancelled);
  EXPECT_FALSE(dip.stand.over);
}

TEST(Procedure, FirstEndingIsKept) {
  Walk dip;
  dip.to_start_of_the_dip();
  dip.feed(Is::kConfirm, 140);
  dip.feed(Is::kMotionFailed, 141);
  EXPECT_EQ(dip.feed(Is::kCancel, 141.1), Action::kStop);
  EXPECT_EQ(dip.stand.ending, Ending::kFailed);
}

}  // namespace
}  // namespace hydroprint::dip
