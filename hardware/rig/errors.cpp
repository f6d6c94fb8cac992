#include "hardware/rig/errors.h"

#include <string>

#include "hardware/rig/state_names.h"

namespace hydroprint::rig {
namespace {

struct Words {
  const char* what;
  const char* remedy;
  const char* reason;
};

Words words(Cause cause) {
  switch (cause) {
    case Cause::kLinkLost:
      return {"the drive did not answer while it was armed", "check its power and its cable",
              "RIG_OFFLINE"};
    case Cause::kAlarm:
      return {"the drive raised an alarm", "remove its cause as the drive's text says",
              "RIG_FAULTED"};
    case Cause::kDropped:
      return {"the drive gave up torque or its home by itself, as after a power cut",
              "check its power supply", "RIG_FAULTED"};
    case Cause::kLimit:
      return {"an end switch was hit", "see what is in the way and check the soft limits",
              "LIMIT_EXCEEDED"};
    case Cause::kGuard:
      return {"the axis left its soft limits", "check the home switch and rig.end_*_mm",
              "LIMIT_EXCEEDED"};
    case Cause::kFollowingError:
      return {"the axis is not where it was told to be", "see what blocks it, or slips",
              "RIG_FAULTED"};
    case Cause::kUnexpectedMotion:
      return {"the axis moved and nobody told it to", "see who else commands the drive",
              "RIG_FAULTED"};
    case Cause::kConfigUnsafe:
      return {"the drive's watchdog would not stop it any more", "set up its watchdog",
              "DRIVE_CONFIG_UNSAFE"};
    case Cause::kStopButton:
      return {"the stop button was pressed", "release it", "STOP_BUTTON"};
    case Cause::kNone:
      break;
  }
  return {"the motion was stopped", "look at the rig", "STATE_FORBIDS"};
}

struct Answer {
  Code code;
  const char* text;
};

Answer answer(Refusal refusal, State state) {
  switch (refusal) {
    case Refusal::kOffline:
      return {Code::kFailedPrecondition,
              "the drive does not answer; check its power, its cable and rig.drive"};
    case Refusal::kFaulted:
      return {Code::kFailedPrecondition, "the rig wants a reset"};
    case Refusal::kNotHomed:
      return {Code::kFailedPrecondition, "where the axis is, is not known; home it first"};
    case Refusal::kMotionInProgress:
      return {Code::kAborted, "another motion is under way; wait for its end, or stop it"};
    case Refusal::kConfigUnsafe:
      return {Code::kFailedPrecondition,
              "the drive is not set up to stop by itself when the link is lost; see what it lacks"};
    case Refusal::kStateForbids:
      break;
  }
  if (state == State::kDisarmed) return {Code::kFailedPrecondition, "the rig is not armed; arm it"};
  return {Code::kFailedPrecondition,
          "the stop button was pressed; release it, then reset, arm and home"};
}

}  // namespace

Error refused(Refusal refusal, const Condition& condition) {
  const Answer said = answer(refusal, condition.state);
  Error out{said.code, said.text, std::string(reason(refusal)), {}};
  out.metadata["state"] = name(condition.state);
  if (condition.cause == Cause::kNone) return out;
  out.metadata["cause"] = name(condition.cause);
  if (refusal != Refusal::kFaulted) return out;
  const Words why = words(condition.cause);
  out.message += std::string(": ") + why.what + "; " + why.remedy + ", then reset, arm and home";
  return out;
}

Error failed(Cause cause) {
  const Words why = words(cause);
  return {Code::kFailedPrecondition,
          std::string(why.what) + "; " + why.remedy + ", then reset, arm and home",
          why.reason,
          {{"cause", std::string(name(cause))}}};
}

}  // namespace hydroprint::rig
