#include "hardware/rig/state_names.h"

namespace hydroprint::rig {

std::string_view name(State state) {
  switch (state) {
    case State::kOffline:
      return "OFFLINE";
    case State::kDisarmed:
      return "DISARMED";
    case State::kUnhomed:
      return "UNHOMED";
    case State::kIdle:
      return "IDLE";
    case State::kMoving:
      return "MOVING";
    case State::kDipping:
      return "DIPPING";
    case State::kStopping:
      return "STOPPING";
    case State::kFault:
      return "FAULT";
    case State::kEstopped:
      return "ESTOPPED";
  }
  return "OFFLINE";
}

std::string_view name(Motion motion) {
  switch (motion) {
    case Motion::kNone:
      return "NONE";
    case Motion::kHome:
      return "HOME";
    case Motion::kMove:
      return "MOVE";
    case Motion::kJog:
      return "JOG";
    case Motion::kDip:
      return "DIP";
  }
  return "NONE";
}

std::string_view name(Cause cause) {
  switch (cause) {
    case Cause::kNone:
      return "NONE";
    case Cause::kLinkLost:
      return "LINK_LOST";
    case Cause::kAlarm:
      return "DRIVE_ALARM";
    case Cause::kDropped:
      return "DRIVE_RESTARTED";
    case Cause::kLimit:
      return "END_SWITCH";
    case Cause::kGuard:
      return "OUTSIDE_LIMITS";
    case Cause::kFollowingError:
      return "FOLLOWING_ERROR";
    case Cause::kUnexpectedMotion:
      return "UNEXPECTED_MOTION";
    case Cause::kOverspeed:
      return "OVERSPEED";
    case Cause::kWrongDirection:
      return "WRONG_DIRECTION";
    case Cause::kPositionJumped:
      return "POSITION_JUMPED";
    case Cause::kFeedback:
      return "FEEDBACK_INCONSISTENT";
    case Cause::kHomingFailed:
      return "HOMING_FAILED";
    case Cause::kStopNotObeyed:
      return "STOP_NOT_OBEYED";
    case Cause::kConfigUnsafe:
      return "DRIVE_CONFIG_UNSAFE";
    case Cause::kStopButton:
      return "STOP_BUTTON";
  }
  return "NONE";
}

ErrorReason reason(Refusal refusal) {
  switch (refusal) {
    case Refusal::kOffline:
      return ErrorReason::RIG_OFFLINE;
    case Refusal::kFaulted:
      return ErrorReason::RIG_FAULTED;
    case Refusal::kNotHomed:
      return ErrorReason::RIG_NOT_HOMED;
    case Refusal::kMotionInProgress:
      return ErrorReason::MOTION_IN_PROGRESS;
    case Refusal::kStateForbids:
      return ErrorReason::STATE_FORBIDS;
    case Refusal::kConfigUnsafe:
      return ErrorReason::DRIVE_CONFIG_UNSAFE;
  }
  return ErrorReason::STATE_FORBIDS;
}

}  // namespace hydroprint::rig
