#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace hydroprint::rig {

/// The state of the rig; README.md contains a diagram of the transitions.
enum class State : std::uint8_t {
  kOffline,   ///< the drive does not respond: nothing is known
  kDisarmed,  ///< the drive responds and holds no torque
  kUnhomed,   ///< armed, but the position is unknown: only homing is allowed
  kIdle,      ///< armed, homed, at rest
  kMoving,    ///< homing, a move or a jog
  kDipping,
  kStopping,  ///< stop sent, standstill not yet observed
  kFault,     ///< at rest after a fault: a reset is required
  kEstopped,  ///< the stop button was pressed: release it, reset, arm and home
};

enum class Motion : std::uint8_t { kNone, kHome, kMove, kJog, kDip };

/// The fault that requires a reset.
enum class Cause : std::uint8_t {
  kNone,
  kLinkLost,          ///< link lost while armed
  kAlarm,             ///< raised by the drive
  kDropped,           ///< the drive lost torque or home position: it was restarted
  kLimit,             ///< limit switch
  kGuard,             ///< the axis left its soft limits
  kFollowingError,    ///< the axis is not at its commanded position, or a jog does not move it
  kUnexpectedMotion,  ///< the axis moves without a command
  kOverspeed,         ///< the axis moves faster than commanded
  kWrongDirection,    ///< a jog moves the axis the wrong way
  kPositionJumped,    ///< the position changed by more than the axis can move
  kFeedback,          ///< position and velocity disagree
  kHomingFailed,      ///< homing was not seen to find the home switch, or ended elsewhere
  kStopNotObeyed,     ///< the drive acknowledged a stop, but does not slow down
  kConfigUnsafe,      ///< the drive's watchdog became unsafe while the rig was armed
  kStopButton,
};

/// The state of the link to the drive.
enum class Link : std::uint8_t {
  kNone,    ///< no response
  kUnsafe,  ///< responds, but is the wrong drive, or its watchdog would not stop the axis
  kSafe,
};

/// A request to the drive that it has not confirmed yet.
enum class Pending : std::uint8_t { kNone, kArm, kReset };

/// The complete state on which decisions about the next action are based.
struct Condition {
  State state = State::kOffline;
  Motion motion = Motion::kNone;  ///< the motion in progress
  Cause cause = Cause::kNone;     ///< kept until a reset, also in STOPPING and OFFLINE
  Link link = Link::kNone;
  Pending pending = Pending::kNone;
  /// Set by this state machine after homing; the drive's own homed bit is not sufficient.
  bool homed = false;
  bool button = false;  ///< pressed at the last poll

  bool operator==(const Condition&) const = default;
};

/// The result of a valid poll.
struct Bits {
  bool moving = false;
  bool enabled = false;  ///< the drive holds torque
  bool homed = false;    ///< the drive reports that its position is known
  bool alarm = false;
  bool button = false;  ///< stop input active
  bool limit = false;   ///< either limit switch is active

  bool operator==(const Bits&) const = default;
};

struct Event {
  enum class Kind : std::uint8_t {
    kSeen,    ///< first valid poll after connecting; `safe`: identity and watchdog are correct
    kSample,  ///< any later poll
    kLost,    ///< three polls missed, 250 ms without a valid poll, or no connection
    kStandstillAssumed,  ///< lost for so long that the watchdog must have stopped the axis
    kMotionDone,         ///< the drive is at rest at the motion's target
    kJogOver,            ///< the jog was released, or has reached its limit
    kFault,              ///< observed (observe.h) or found by the supervisor: `cause`
    kTimedOut,           ///< a pending confirmation took too long
    // Commands follow. Only commands can be refused.
    kStop,  ///< never refused
    kArm,
    kDisarm,
    kHome,
    kMove,
    kJog,  ///< repeated while jogging: new speed
    kDip,
    kReset,
  };
  Kind kind = Kind::kSample;
  Bits bits = {};              ///< result of the poll, for kSeen and kSample
  bool safe = false;           ///< only for kSeen
  Cause cause = Cause::kNone;  ///< only for kFault
};

/// Actions for the control loop, in this order.
struct Actions {
  bool stop = false;
  bool disable = false;
  bool clear_alarm = false;
  bool enable = false;
  bool start = false;  ///< starts the motion of the command

  bool operator==(const Actions&) const = default;
};

enum class Refusal : std::uint8_t {
  kOffline,
  kFaulted,
  kNotHomed,
  kMotionInProgress,
  kStateForbids,
  kConfigUnsafe,
};

struct Step {
  Condition next;
  Actions actions = {};
  std::optional<Refusal> refusal = {};  ///< if set, `next` is unchanged and there are no actions
};

/// Computes the reaction to an event; every event is valid in every condition. Rules:
/// - nothing moves before arming, and only homing is allowed before homing;
/// - a reset, a reconnect or a released button starts no motion;
/// - everything that requires a reset also discards the home position, and so does disarming;
/// - STOPPING ends when the axis is seen at rest. With the link lost, it ends when the drive's
///   watchdog must have stopped the axis (then OFFLINE). It also ends as ESTOPPED, which cannot be
///   left while the axis moves.
[[nodiscard]] Step step(const Condition& condition, const Event& event);

/// Returns whether torque is or may be on.
[[nodiscard]] bool is_armed(State state);
/// Returns whether a commanded motion is in progress.
[[nodiscard]] bool in_motion(State state);

}  // namespace hydroprint::rig
