#include "daemon/dip/state_machine.h"

namespace hydroprint::dip {
namespace {

bool is_dipping(Step step) { return step >= Step::kDescend; }

Outcome stay(const Stand& stand) { return {stand}; }

Outcome enter(Stand stand, Step step, double time_s) {
  stand.step = step;
  stand.since_s = time_s;
  return {stand};
}

Step after(Step step) { return static_cast<Step>(static_cast<int>(step) + 1); }

/// Ends the dip: immediately if the axis is at rest; otherwise the motion has to stop first.
Outcome end(Stand stand, Ending ending, double time_s, bool in_motion) {
  if (stand.ending != Ending::kNone) return stay(stand);
  stand.ending = ending;
  stand.ending_s = time_s;
  stand.over = !in_motion;
  return {stand};
}

Outcome break_off(const Stand& stand, Ending ending, double time_s) {
  const bool in_motion = awaits(stand.step) == Awaits::kMotion;
  Outcome out = end(stand, ending, time_s, in_motion);
  if (in_motion) out.action = Action::kStop;  // repeating a stop does no harm
  return out;
}

/// Continues after the operator's confirmation.
Outcome go_on(Stand stand, const Event& event) {
  Outcome out = enter(stand, after(stand.step), event.time_s);
  switch (stand.step) {
    case Step::kLoadObject:
      out.next.loaded_mm = event.position_mm;
      break;
    case Step::kFindContact:
      out.next.contact_mm = event.position_mm;
      out.action = Action::kRise;
      break;
    case Step::kSprayActivator:
      out.next.sprayed_s = event.time_s;
      break;
    case Step::kStartDip:
      out.action = Action::kDip;
      break;
    default:
      break;
  }
  return out;
}

Outcome confirm(const Stand& stand, const Event& event) {
  if (event.step < stand.step) return stay(stand);  // confirmed before
  const bool waits = event.step == stand.step && awaits(stand.step) == Awaits::kOperator;
  if (!waits || stand.ending != Ending::kNone) return {stand, Action::kNone, true};
  return go_on(stand, event);
}

Outcome tick(Stand stand, const Event& event, const Clocks& clocks) {
  if (stand.ending != Ending::kNone) return stay(stand);
  if (clocks.skip && awaits(stand.step) == Awaits::kOperator) return go_on(stand, event);
  const double elapsed_s = event.time_s - stand.since_s;
  const bool soaked = stand.step == Step::kSoak && (clocks.skip || elapsed_s >= clocks.soak_s);
  const bool activated =
      stand.step == Step::kActivate && (clocks.skip || elapsed_s >= clocks.activator_wait_s);
  if (soaked || activated) return enter(stand, after(stand.step), event.time_s);
  const double good_s = clocks.activator_wait_s + clocks.activation_window_s;
  if (stand.step == Step::kStartDip && stand.sprayed_s) {
    stand.late = event.time_s > *stand.sprayed_s + good_s;
  }
  return stay(stand);
}

Outcome finish_motion(const Stand& stand, const Event& event) {
  if (stand.ending != Ending::kNone) return stay(stand);
  if (stand.step == Step::kClear) return enter(stand, after(stand.step), event.time_s);
  if (!is_dipping(stand.step)) return stay(stand);
  return end(stand, Ending::kSucceeded, event.time_s, true);
}

}  // namespace

std::string_view name(Step step) {
  constexpr std::string_view kNames[] = {
      "PRINT_FILM",      "LOAD_OBJECT", "FIND_CONTACT", "CLEAR",   "LAY_FILM", "SOAK",
      "SPRAY_ACTIVATOR", "ACTIVATE",    "START_DIP",    "DESCEND", "HOLD",     "RETRACT"};
  return kNames[static_cast<int>(step) - 1];
}

std::string_view name(Ending ending) {
  constexpr std::string_view kNames[] = {"", "SUCCEEDED", "FAILED", "CANCELLED", "INTERRUPTED"};
  return kNames[static_cast<int>(ending)];
}

Awaits awaits(Step step) {
  switch (step) {
    case Step::kSoak:
    case Step::kActivate:
      return Awaits::kClock;
    case Step::kClear:
    case Step::kDescend:
    case Step::kHold:  // the axis rests, but the dip's motion is not complete
    case Step::kRetract:
      return Awaits::kMotion;
    default:
      return Awaits::kOperator;
  }
}

Outcome proceed(const Stand& stand, const Event& event, const Clocks& clocks) {
  using Kind = Event::Kind;
  if (stand.over && event.kind != Kind::kConfirm) return stay(stand);
  const bool in_motion = awaits(stand.step) == dip::Awaits::kMotion;
  switch (event.kind) {
    case Kind::kTick:
      return tick(stand, event, clocks);
    case Kind::kConfirm:
      return confirm(stand, event);
    case Kind::kAtDepth:
      if (stand.step != Step::kDescend || stand.ending != Ending::kNone) return stay(stand);
      return enter(stand, Step::kHold, event.time_s);
    case Kind::kRising:
      if (stand.step != Step::kHold || stand.ending != Ending::kNone) return stay(stand);
      return enter(stand, Step::kRetract, event.time_s);
    case Kind::kMotionDone:
      return finish_motion(stand, event);
    case Kind::kMotionStopped:
      return in_motion ? end(stand, Ending::kCancelled, event.time_s, true) : stay(stand);
    case Kind::kMotionFailed:
      return in_motion ? end(stand, Ending::kFailed, event.time_s, true) : stay(stand);
    case Kind::kPlaceLost:
      if (in_motion || !has_the_rig(stand.step)) return stay(stand);
      return end(stand, Ending::kFailed, event.time_s, false);
    case Kind::kOrderRefused:
      return end(stand, Ending::kFailed, event.time_s, false);
    case Kind::kAtRest: {
      Stand next = stand;
      next.over = stand.ending != Ending::kNone;
      return {next};
    }
    case Kind::kCancel:
      return break_off(stand, Ending::kCancelled, event.time_s);
    case Kind::kShutdown:
      return break_off(stand, Ending::kInterrupted, event.time_s);
  }
  return stay(stand);
}

}  // namespace hydroprint::dip
