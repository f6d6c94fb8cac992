#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace hydroprint::rig {

/// What the rig is doing; README.md draws how one follows another.
enum class State : std::uint8_t {
  kOffline,   ///< the drive does not answer: nothing is known
  kDisarmed,  ///< the drive answers and holds no torque
  kUnhomed,   ///< armed, but where the axis is, is not known: only homing may move
  kIdle,      ///< armed, homed, at rest
  kMoving,    ///< homing, a move or a jog
  kDipping,
  kStopping,  ///< told to stop, not seen at rest yet
  kFault,     ///< at rest after something went wrong: wants a reset
  kEstopped,  ///< the stop button was pressed: wants it released, a reset, arming and homing
};

enum class Motion : std::uint8_t { kNone, kHome, kMove, kJog, kDip };

/// Why the rig has to be reset.
enum class Cause : std::uint8_t {
  kNone,
  kLinkLost,          ///< while armed
  kAlarm,             ///< the drive's own
  kDropped,           ///< the drive gave up torque or its home by itself: it was restarted
  kLimit,             ///< an end switch
  kGuard,             ///< the axis left its soft limits
  kFollowingError,    ///< the axis is not where it was told to be
  kUnexpectedMotion,  ///< the axis moves and nobody told it to
  kConfigUnsafe,      ///< the drive lost its watchdog while armed
  kStopButton,
};

/// What is known of the drive at the other end.
enum class Link : std::uint8_t {
  kNone,    ///< it does not answer
  kUnsafe,  ///< it answers; not the right drive, or its watchdog would not stop it
  kSafe,
};

/// What the drive was asked for and has not shown yet.
enum class Pending : std::uint8_t { kNone, kArm, kReset };

/// All that decides what may happen next.
struct Condition {
  State state = State::kOffline;
  Motion motion = Motion::kNone;  ///< under way
  Cause cause = Cause::kNone;     ///< kept until a reset, through STOPPING and OFFLINE
  Link link = Link::kNone;
  Pending pending = Pending::kNone;
  bool homed = false;   ///< in this condition's own judgement; a drive may claim more
  bool button = false;  ///< pressed when last seen

  bool operator==(const Condition&) const = default;
};

/// One clean look at the drive.
struct Bits {
  bool moving = false;
  bool enabled = false;  ///< holds torque
  bool homed = false;    ///< says that it knows where it is
  bool alarm = false;
  bool button = false;  ///< stop input active
  bool limit = false;   ///< on either end switch

  bool operator==(const Bits&) const = default;
};

struct Event {
  enum class Kind : std::uint8_t {
    kSeen,    ///< first clean look after a connect; `safe` is the verdict on identity and watchdog
    kSample,  ///< any later look
    kLost,    ///< three polls missed, 250 ms without a clean look, or no connection
    kStandstillAssumed,  ///< lost for longer than the drive's own watchdog needs to stop it
    kMotionDone,         ///< the drive is at rest where the motion was to end
    kJogOver,            ///< nobody holds the jog any more, or it has come to its limit
    kOutsideLimits,
    kFollowingError,
    kTimedOut,  ///< what is pending takes too long
    // Commands; only these can be refused.
    kStop,  ///< never is
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

/// What the owner of the drive must do, in this order.
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
  std::optional<Refusal> refusal = {};  ///< if any: `next` is as before and nothing is to be done
};

/// What follows from an event; every event is good in every condition. Rules:
/// - nothing moves before arming, and nothing but homing before homing;
/// - a reset, a reconnect or a released button starts nothing;
/// - whatever costs the reset also costs the home position, and so does disarming;
/// - STOPPING ends when the axis is seen at rest; with the link lost, when the drive's watchdog
/// must
///   have stopped it (then OFFLINE); or as ESTOPPED, which cannot be left while the axis moves.
[[nodiscard]] Step step(const Condition& condition, const Event& event);

/// Torque is or may be on.
[[nodiscard]] bool is_armed(State state);
/// A motion that was commanded is under way.
[[nodiscard]] bool in_motion(State state);

}  // namespace hydroprint::rig
