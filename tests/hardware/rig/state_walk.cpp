#include "tests/hardware/rig/state_walk.h"

#include <gtest/gtest.h>

#include <deque>
#include <ostream>
#include <tuple>

#include "hardware/rig/state_names.h"

namespace hydroprint::rig {
namespace {

using Kind = Event::Kind;

}  // namespace

void PrintTo(const Condition& c, std::ostream* out) {
  *out << name(c.state) << " motion " << name(c.motion) << " cause " << name(c.cause) << " link "
       << static_cast<int>(c.link) << " pending " << static_cast<int>(c.pending) << " homed "
       << c.homed << " button " << c.button;
}

void PrintTo(const Event& event, std::ostream* out) {
  const Bits& b = event.bits;
  *out << "event " << static_cast<int>(event.kind) << " moving " << b.moving << " enabled "
       << b.enabled << " homed " << b.homed << " alarm " << b.alarm << " button " << b.button
       << " limit " << b.limit << " safe " << event.safe;
}

std::string text(const Condition& c, const Event& event) {
  return "from " + ::testing::PrintToString(c) + "\nby " + ::testing::PrintToString(event) +
         "\nto " + ::testing::PrintToString(step(c, event).next);
}

std::vector<Cause> observed_causes() {
  return {Cause::kGuard,     Cause::kFollowingError, Cause::kUnexpectedMotion,
          Cause::kOverspeed, Cause::kWrongDirection, Cause::kPositionJumped,
          Cause::kFeedback,  Cause::kHomingFailed,   Cause::kStopNotObeyed};
}

bool is_start(const Event& event) {
  return event.kind == Kind::kHome || event.kind == Kind::kMove || event.kind == Kind::kJog ||
         event.kind == Kind::kDip;
}

bool is_command(const Event& event) { return event.kind >= Kind::kStop; }

bool has_bits(const Event& event) {
  return event.kind == Kind::kSeen || event.kind == Kind::kSample;
}

std::vector<Event> all_events() {
  std::vector<Event> out;
  for (int kind = 0; kind <= static_cast<int>(Kind::kReset); ++kind) {
    const Event event{static_cast<Kind>(kind)};
    if (event.kind == Kind::kFault) {
      for (const Cause cause : observed_causes())
        out.push_back({.kind = Kind::kFault, .cause = cause});
      continue;
    }
    if (!has_bits(event)) {
      out.push_back(event);
      continue;
    }
    for (int i = 0; i < 128; ++i) {
      const auto bit = [i](int place) { return (i >> place & 1) != 0; };
      const Bits bits{bit(0), bit(1), bit(2), bit(3), bit(4), bit(5)};
      if (bit(6) && event.kind == Kind::kSample) continue;
      out.push_back({event.kind, bits, bit(6)});
    }
  }
  return out;
}

std::vector<Condition> all_conditions() {
  std::vector<Condition> out;
  for (int state = 0; state <= static_cast<int>(State::kEstopped); ++state)
    for (int motion = 0; motion <= static_cast<int>(Motion::kDip); ++motion)
      for (int cause = 0; cause <= static_cast<int>(Cause::kStopButton); ++cause)
        for (int link = 0; link <= static_cast<int>(Link::kSafe); ++link)
          for (int pending = 0; pending <= static_cast<int>(Pending::kReset); ++pending)
            for (int flags = 0; flags < 4; ++flags)
              out.push_back({static_cast<State>(state), static_cast<Motion>(motion),
                             static_cast<Cause>(cause), static_cast<Link>(link),
                             static_cast<Pending>(pending), (flags & 1) != 0, (flags & 2) != 0});
  return out;
}

bool makes_sense(const Condition& c) {
  const bool reset_owed = c.cause != Cause::kNone;
  if (c.homed && (reset_owed || !is_armed(c.state))) return false;
  if (c.homed && c.state == State::kUnhomed) return false;
  if (c.state == State::kIdle && !c.homed) return false;
  if (in_motion(c.state) != (c.motion != Motion::kNone)) return false;
  if ((c.state == State::kDipping) != (c.motion == Motion::kDip)) return false;
  if (in_motion(c.state) && c.homed == (c.motion == Motion::kHome)) return false;
  if ((is_armed(c.state) || c.state == State::kDisarmed) && c.state != State::kStopping &&
      reset_owed)
    return false;
  if (c.state == State::kFault && (!reset_owed || c.cause == Cause::kStopButton)) return false;
  if ((c.state == State::kEstopped) && c.cause != Cause::kStopButton) return false;
  if (c.state == State::kStopping && c.cause == Cause::kStopButton) return false;
  if (c.state == State::kOffline && c.link != Link::kNone) return false;
  if (c.link == Link::kNone && c.state != State::kOffline &&
      !(c.state == State::kStopping && reset_owed))
    return false;
  if (c.link == Link::kUnsafe && is_armed(c.state) && c.state != State::kStopping) return false;
  if (c.pending == Pending::kArm && (c.state != State::kDisarmed || c.link != Link::kSafe))
    return false;
  if (c.pending == Pending::kReset && c.state != State::kFault && c.state != State::kEstopped)
    return false;
  return !c.button || c.state == State::kEstopped || c.state == State::kOffline;
}

namespace {

auto fields(const Condition& c) {
  return std::tuple(c.state, c.motion, c.cause, c.link, c.pending, c.homed, c.button);
}

}  // namespace

bool ByFields::operator()(const Condition& a, const Condition& b) const {
  return fields(a) < fields(b);
}

Conditions reach(const Conditions& start, const Allowed& allowed, const Witness& witness) {
  std::vector<Event> events;
  for (const Event& event : all_events()) {
    if (allowed(event)) events.push_back(event);
  }
  Conditions seen = start;
  std::deque<Condition> open(start.begin(), start.end());
  while (!open.empty()) {
    const Condition c = open.front();
    open.pop_front();
    for (const Event& event : events) {
      const Step taken = step(c, event);
      if (witness) witness(c, event, taken);
      if (seen.insert(taken.next).second) open.push_back(taken.next);
    }
  }
  return seen;
}

const Conditions& reachable() {
  static const Conditions all = reach({Condition{}}, [](const Event&) { return true; });
  return all;
}

Conditions those(const std::function<bool(const Condition&)>& wanted) {
  Conditions out;
  for (const Condition& c : reachable()) {
    if (wanted(c)) out.insert(c);
  }
  return out;
}

void for_each_step(const Witness& claim) {
  const auto events = all_events();
  for (const Condition& c : reachable()) {
    for (const Event& event : events) {
      claim(c, event, step(c, event));
      if (::testing::Test::HasFailure()) {
        ADD_FAILURE() << text(c, event);
        return;
      }
    }
  }
}

}  // namespace hydroprint::rig
