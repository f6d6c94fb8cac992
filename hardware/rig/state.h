#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace hydroprint::rig {

/// The state of the rig; README.md draws the transitions.
enum class State : std::uint8_t {
  kOffline,   ///< the drive does not respond: nothing is known
  kDisarmed,  ///< the drive answers and holds no torque
  kUnhomed,   ///< armed, but the position is unknown: only homing is allowed
  kIdle,      ///< armed, homed, at rest
  kMoving,    ///< homing, a move or a jog
  kDipping,
  kStopping,  ///< stop sent, standstill not seen yet
  kFault,     ///< at rest after a fault: must be reset
  kEstopped,  ///< the stop button was pressed: release it, reset, arm and home
};

enum class Motion : std::uint8_t { kNone, kHome, kMove, kJog, kDip };

/// The fault that requires a reset.
enum class Cause : std::uint8_t {
  kNone,
  kLinkLost,          ///< while armed
  kAlarm,             ///< raised by the drive
  kDropped,           ///< the drive lost torque or home position: it was restarted
  kLimit,             ///< limit switch
  kGuard,             ///< the axis left its soft limits
  kFollowingError,    ///< the axis is not at its commanded position
  kUnexpectedMotion,  ///< the axis moves without a command
  kConfigUnsafe,      ///< the drive's watchdog was turned off while armed
  kStopButton,
};

/// The state of the link to the drive.
enum class Link : std::uint8_t {
  kNone,    ///< no response
  kUnsafe,  ///< responds, but is the wrong drive, or its watchdog would not stop it
  kSafe,
};

/// A request to the drive that it has not confirmed yet.
enum class Pending : std::uint8_t { kNone, kArm, kReset };

/// The complete input to decisions about the next action.
struct Condition {
  State state = State::kOffline;
  Motion motion = Motion::kNone;  ///< in progress
  Cause cause = Cause::kNone;     ///< kept until a reset, through STOPPING and OFFLINE
  Link link = Link::kNone;
  Pending pending = Pending::kNone;
  bool homed = false;   ///< determined by this state machine; the drive may claim more
  bool button = false;  ///< pressed at the last poll

  bool operator==(const Condition&) const = default;
};

/// The result of a valid poll.
struct Bits {
  bool moving = false;
  bool enabled = false;  ///< holds torque
  bool homed = false;    ///< claims a known position
  bool alarm = false;
  bool button = false;  ///< stop input active
  bool limit = false;   ///< on either limit switch

  bool operator==(const Bits&) const = default;
};

struct Event {
  enum class Kind : std::uint8_t {
    kSeen,    ///< first valid poll after connecting; `safe`: identity and watchdog are good
    kSample,  ///< any later poll
    kLost,    ///< three polls missed, 250 ms without a valid poll, or no connection
    kStandstillAssumed,  ///< lost for longer than the drive's watchdog needs
    kMotionDone,         ///< the drive is at rest at the motion's target
    kJogOver,            ///< the jog was released, or has reached its limit
    kOutsideLimits,
    kFollowingError,
    kTimedOut,  ///< a pending confirmation takes too long
    // Commands; only these can be refused.
    kStop,  ///< never refused
    kArm,
    kDisarm,
    kHome,
    kMove,
    kJog,  ///< again while jogging: another speed
    kDip,
    kReset,
  };
  Kind kind = Kind::kSample;
  Bits bits = {};     ///< of kSeen and kSample
  bool safe = false;  ///< of kSeen
};

/// Actions for the control loop, in this order.
struct Actions {
  bool stop = false;
  bool disable = false;
  bool clear_alarm = false;
  bool enable = false;
  bool start = false;  ///< the motion of the command

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

/// Whether torque is or may be on.
[[nodiscard]] bool is_armed(State state);
/// Whether a commanded motion is in progress.
[[nodiscard]] bool in_motion(State state);

}  // namespace hydroprint::rig
