#include "hardware/rig/state.h"

namespace hydroprint::rig {
namespace {

using Kind = Event::Kind;

Step stay(const Condition& c) { return {c}; }
Step refuse(const Condition& c, Refusal refusal) { return {c, {}, refusal}; }

bool at_rest_armed(State state) { return state == State::kUnhomed || state == State::kIdle; }

State rest(const Condition& c) {
  if (c.cause == Cause::kStopButton) return State::kEstopped;
  if (c.cause != Cause::kNone) return State::kFault;
  return c.homed ? State::kIdle : State::kUnhomed;
}

/// Enters a fault: the axis is stopped, and a reset is required. The first cause is kept.
Step trip(Condition c, Cause cause, bool moving) {
  if (c.cause == Cause::kNone) c.cause = cause;
  c.homed = false;
  c.motion = Motion::kNone;
  c.pending = Pending::kNone;
  c.state = moving ? State::kStopping : rest(c);
  return {c, {.stop = true}};
}

Step press_button(Condition c) {
  const bool news = c.state != State::kEstopped;
  c.cause = Cause::kStopButton;
  c.homed = false;
  c.motion = Motion::kNone;
  c.pending = Pending::kNone;
  c.state = State::kEstopped;
  return {c, {.stop = news}};
}

/// Returns the fault that a poll shows in this condition.
Cause wrong(const Condition& c, const Bits& bits) {
  if (c.homed && bits.limit) return Cause::kLimit;  // most drives also raise an alarm
  if (bits.alarm) return Cause::kAlarm;
  if (is_armed(c.state)) {
    if (c.link == Link::kUnsafe) return Cause::kConfigUnsafe;
    if (!bits.enabled || (c.homed && !bits.homed)) return Cause::kDropped;
  }
  // Without torque, the screw can be turned by hand.
  const bool should_rest = at_rest_armed(c.state) || c.state == State::kDisarmed;
  if (should_rest && bits.moving && bits.enabled) return Cause::kUnexpectedMotion;
  return Cause::kNone;
}

Step disarm(Condition c) {
  c.state = State::kDisarmed;
  c.cause = Cause::kNone;
  c.homed = false;
  c.pending = Pending::kNone;
  return {c, {.disable = true}};
}

Step look_at_fault(const Condition& c, const Bits& bits) {
  if (c.pending == Pending::kReset && !bits.moving && !bits.alarm) return disarm(c);
  if (c.state == State::kFault && bits.moving && bits.enabled) return trip(c, c.cause, true);
  return stay(c);
}

Step look_at_stopping(Condition c, const Bits& bits) {
  if (const Cause cause = wrong(c, bits); cause != Cause::kNone) c = trip(c, cause, true).next;
  if (!bits.moving) c.state = rest(c);
  return stay(c);
}

Step look_at_disarmed(Condition c, const Bits& bits) {
  if (c.pending != Pending::kArm) return {c, {.disable = bits.enabled}};
  if (!bits.enabled) return stay(c);
  c.pending = Pending::kNone;
  c.state = State::kUnhomed;
  return stay(c);
}

Step look(Condition c, const Bits& bits) {
  if (c.link == Link::kNone) return stay(c);  // ignores a poll without a link
  c.button = bits.button;
  if (bits.button) return press_button(c);
  if (c.state == State::kFault || c.state == State::kEstopped) return look_at_fault(c, bits);
  if (c.state == State::kStopping) return look_at_stopping(c, bits);
  if (const Cause cause = wrong(c, bits); cause != Cause::kNone) {
    return trip(c, cause, bits.moving || in_motion(c.state));
  }
  return c.state == State::kDisarmed ? look_at_disarmed(c, bits) : stay(c);
}

Step see(Condition c, const Event& event) {
  c.link = event.safe ? Link::kSafe : Link::kUnsafe;
  if (c.state == State::kOffline) {
    c.state = c.cause == Cause::kNone ? State::kDisarmed : rest(c);
  }
  if (!event.safe) c.pending = Pending::kNone;
  return look(c, event.bits);
}

Step lose(Condition c) {
  c.link = Link::kNone;
  c.pending = Pending::kNone;
  if (in_motion(c.state) || c.state == State::kStopping) return trip(c, Cause::kLinkLost, true);
  if (is_armed(c.state)) c.cause = Cause::kLinkLost;
  c.homed = false;
  c.state = State::kOffline;
  return stay(c);
}

Step assume_standstill(Condition c) {
  if (c.state == State::kStopping && c.link == Link::kNone) c.state = State::kOffline;
  return stay(c);
}

/// A fault that is observed at standstill also leads to STOPPING: the axis may have begun to move.
Step fault(const Condition& c, Cause cause) {
  if (in_motion(c.state) || at_rest_armed(c.state)) return trip(c, cause, true);
  if (c.state != State::kStopping || cause != Cause::kStopNotObeyed) return stay(c);
  // Replaces the first cause, because a person must act now.
  Condition next = c;
  next.cause = cause;
  next.homed = false;
  return stay(next);
}

Step finish_motion(Condition c) {
  if (!in_motion(c.state)) return stay(c);
  c.homed = true;  // before homing, the only possible motion is homing
  c.motion = Motion::kNone;
  c.state = State::kIdle;
  return stay(c);
}

Step stop(Condition c) {
  Step out{c, {.stop = true, .disable = c.pending == Pending::kArm}};
  out.next.pending = Pending::kNone;
  if (in_motion(c.state)) {
    out.next.state = State::kStopping;
    out.next.motion = Motion::kNone;
  }
  return out;
}

Step time_out(Condition c) {
  const bool arming = c.pending == Pending::kArm;
  c.pending = Pending::kNone;
  return {c, {.disable = arming}};
}

/// Returns why this state permits no command except a stop; nullopt if it permits others.
std::optional<Refusal> out_of_order(const Condition& c) {
  switch (c.state) {
    case State::kOffline:
      return Refusal::kOffline;
    case State::kMoving:
    case State::kDipping:
    case State::kStopping:
      return Refusal::kMotionInProgress;
    case State::kFault:
      return Refusal::kFaulted;
    case State::kEstopped:
      return Refusal::kStateForbids;
    default:
      return std::nullopt;
  }
}

Step arm(Condition c) {
  if (const auto refusal = out_of_order(c)) return refuse(c, *refusal);
  if (c.link != Link::kSafe) return refuse(c, Refusal::kConfigUnsafe);
  if (c.state != State::kDisarmed) return stay(c);
  c.pending = Pending::kArm;
  return {c, {.enable = true}};
}

Step ask_to_disarm(const Condition& c) {
  if (c.state == State::kFault) return {c, {.disable = true}};
  if (c.state == State::kEstopped) return stay(c);  // the button removed the torque
  if (const auto refusal = out_of_order(c)) return refuse(c, *refusal);
  return disarm(c);
}

Step start(Condition c, Motion motion) {
  const bool jogs_on =
      c.state == State::kMoving && c.motion == Motion::kJog && motion == Motion::kJog;
  if (!jogs_on) {
    if (const auto refusal = out_of_order(c)) return refuse(c, *refusal);
    if (c.state == State::kDisarmed) return refuse(c, Refusal::kStateForbids);
    if (motion != Motion::kHome && !c.homed) return refuse(c, Refusal::kNotHomed);
  }
  if (motion == Motion::kHome) c.homed = false;
  c.motion = motion;
  c.state = motion == Motion::kDip ? State::kDipping : State::kMoving;
  return {c, {.start = true}};
}

Step reset(Condition c) {
  if (c.state == State::kEstopped && c.button) return refuse(c, Refusal::kStateForbids);
  if (c.state != State::kFault && c.state != State::kEstopped) {
    if (const auto refusal = out_of_order(c)) return refuse(c, *refusal);
    return stay(c);
  }
  c.pending = Pending::kReset;
  return {c, {.clear_alarm = true}};
}

}  // namespace

Step step(const Condition& c, const Event& event) {
  switch (event.kind) {
    case Kind::kSeen:
      return see(c, event);
    case Kind::kSample:
      return look(c, event.bits);
    case Kind::kLost:
      return lose(c);
    case Kind::kStandstillAssumed:
      return assume_standstill(c);
    case Kind::kMotionDone:
      return finish_motion(c);
    case Kind::kJogOver:
      return c.motion == Motion::kJog ? stop(c) : stay(c);
    case Kind::kFault:
      return fault(c, event.cause);
    case Kind::kTimedOut:
      return time_out(c);
    case Kind::kStop:
      return stop(c);
    case Kind::kArm:
      return arm(c);
    case Kind::kDisarm:
      return ask_to_disarm(c);
    case Kind::kHome:
      return start(c, Motion::kHome);
    case Kind::kMove:
      return start(c, Motion::kMove);
    case Kind::kJog:
      return start(c, Motion::kJog);
    case Kind::kDip:
      return start(c, Motion::kDip);
    case Kind::kReset:
      return reset(c);
  }
  return stay(c);
}

bool in_motion(State state) { return state == State::kMoving || state == State::kDipping; }

bool is_armed(State state) {
  return at_rest_armed(state) || in_motion(state) || state == State::kStopping;
}

}  // namespace hydroprint::rig
