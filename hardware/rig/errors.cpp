#include "hardware/rig/errors.h"

#include <fmt/format.h>

#include <string>

#include "hardware/rig/state_names.h"

namespace hydroprint::rig {
namespace {

struct Words {
  const char* what;
  const char* remedy;
  ErrorReason reason;
};

Words words(Cause cause) {
  switch (cause) {
    case Cause::kLinkLost:
      return {"the drive stopped responding while it was armed", "check its power and cable",
              ErrorReason::RIG_OFFLINE};
    case Cause::kAlarm:
      return {"the drive raised an alarm", "remove the cause that the alarm names",
              ErrorReason::RIG_FAULTED};
    case Cause::kDropped:
      return {"the drive lost its torque or home position, as after a power failure",
              "check its power supply", ErrorReason::RIG_FAULTED};
    case Cause::kLimit:
      return {"a limit switch was hit", "remove any obstacle and check the soft limits",
              ErrorReason::LIMIT_EXCEEDED};
    case Cause::kGuard:
      return {"the axis left its soft limits", "check the home switch and rig.end_*_mm",
              ErrorReason::LIMIT_EXCEEDED};
    case Cause::kFollowingError:
      return {"the axis is not at its commanded position", "check for blocking or slipping parts",
              ErrorReason::RIG_FAULTED};
    case Cause::kUnexpectedMotion:
      return {"the axis moved without a command", "find out what else commands the drive",
              ErrorReason::RIG_FAULTED};
    case Cause::kOverspeed:
      return {"the axis moved faster than commanded",
              "compare the profile's counts_per_mm_per_s and the drive's speeds",
              ErrorReason::RIG_FAULTED};
    case Cause::kWrongDirection:
      return {"the axis moved in the wrong direction",
              "check the sign of the profile's counts_per_mm and the wiring of the motor",
              ErrorReason::RIG_FAULTED};
    case Cause::kPositionJumped:
      return {"the drive's position changed by more than the axis can move",
              "find out what sets the drive's position to zero, and check the encoder's cable",
              ErrorReason::RIG_FAULTED};
    case Cause::kFeedback:
      return {"the drive's position and velocity disagree",
              "check the encoder's cable and the registers of position and velocity in the profile",
              ErrorReason::RIG_FAULTED};
    case Cause::kHomingFailed:
      return {"homing was not seen to find the home switch, or did not end at position 0",
              "check the home switch, its cable and the drive's settings for homing",
              ErrorReason::RIG_FAULTED};
    case Cause::kStopNotObeyed:
      return {
          "the drive acknowledged a stop but did not slow down; PRESS THE STOP BUTTON ON THE RIG",
          "check the drive before you use the rig again", ErrorReason::RIG_FAULTED};
    case Cause::kConfigUnsafe:
      return {"the drive's watchdog would no longer stop the axis",
              "correct the settings of the watchdog", ErrorReason::DRIVE_CONFIG_UNSAFE};
    case Cause::kStopButton:
      return {"the stop button was pressed", "release it", ErrorReason::STOP_BUTTON};
    case Cause::kNone:
      break;
  }
  return {"the motion was stopped", "check the rig", ErrorReason::STATE_FORBIDS};
}

struct Answer {
  Code code;
  const char* text;
};

Answer answer(Refusal refusal, State state) {
  switch (refusal) {
    case Refusal::kOffline:
      return {Code::kFailedPrecondition,
              "the drive does not respond; check its power, its cable and rig.drive"};
    case Refusal::kFaulted:
      return {Code::kFailedPrecondition, "the rig must be reset"};
    case Refusal::kNotHomed:
      return {Code::kFailedPrecondition, "the axis position is unknown; home it first"};
    case Refusal::kMotionInProgress:
      return {Code::kAborted, "another motion is in progress; wait until it ends, or stop it"};
    case Refusal::kConfigUnsafe:
      return {
          Code::kFailedPrecondition,
          "the drive is not set up to stop by itself when the link is lost; check its watchdog"};
    case Refusal::kStateForbids:
      break;
  }
  if (state == State::kDisarmed) return {Code::kFailedPrecondition, "the rig is not armed; arm it"};
  return {Code::kFailedPrecondition,
          "the stop button was pressed; release it, then reset, arm and home"};
}

std::string remedy(const Words& why) {
  return fmt::format("{}; {}, then reset, arm and home", why.what, why.remedy);
}

}  // namespace

Error refused(Refusal refusal, const Condition& condition) {
  const Answer entry = answer(refusal, condition.state);
  Error out{entry.code, entry.text, reason(refusal), {}};
  out.metadata["state"] = name(condition.state);
  if (condition.cause == Cause::kNone) return out;
  out.metadata["cause"] = name(condition.cause);
  if (refusal != Refusal::kFaulted) return out;
  out.message += ": " + remedy(words(condition.cause));
  return out;
}

Error failed(Cause cause) {
  const Words why = words(cause);
  return {
      Code::kFailedPrecondition, remedy(why), why.reason, {{"cause", std::string(name(cause))}}};
}

}  // namespace hydroprint::rig
