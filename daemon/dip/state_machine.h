#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace hydroprint::dip {

/// The steps of a dip in order; numbers and meanings are those of hydroprint.v1.DipStatus.Step.
enum class Step : std::uint8_t {
  kPrintFilm = 1,
  kLoadObject,
  kFindContact,
  kClear,
  kLayFilm,
  kSoak,
  kSprayActivator,
  kActivate,
  kStartDip,
  kDescend,
  kHold,
  kRetract,
};
inline constexpr int kSteps = 12;

/// Returns the step's name, for example "FIND_CONTACT".
[[nodiscard]] std::string_view name(Step step);

/// The condition that ends a step.
enum class Awaits : std::uint8_t { kOperator, kClock, kMotion };
[[nodiscard]] Awaits awaits(Step step);

/// Returns whether the dip has exclusive use of the rig, which is the case from its first motion
/// on: the rig must keep its reference, and no other client may move it.
[[nodiscard]] constexpr bool has_the_rig(Step step) { return step >= Step::kClear; }

/// Durations of the clocks in s.
struct Clocks {
  double soak_s = 60;
  double activator_wait_s = 20;
  double activation_window_s = 60;  ///< how long the film stays activated after the waiting time
  bool skip = false;                ///< no confirmations and no clocks: for unattended runs
};

/// The outcome of a dip.
enum class Ending : std::uint8_t { kNone, kSucceeded, kFailed, kCancelled, kInterrupted };
[[nodiscard]] std::string_view name(Ending ending);  ///< "SUCCEEDED"; "" for kNone

/// State of a dip. Times are seconds since it was created.
struct Stand {
  Step step = Step::kPrintFilm;
  double since_s = 0;                ///< start of the step
  Ending ending = Ending::kNone;     ///< once set, it does not change; the axis may still be moving
  double ending_s = 0;               ///< time at which `ending` was set
  bool over = false;                 ///< no further action follows
  bool late = false;                 ///< the film was activated too long ago
  std::optional<double> loaded_mm;   ///< axis position when the object was loaded
  std::optional<double> contact_mm;  ///< axis position at first contact
  std::optional<double> sprayed_s;   ///< time at which the activator was sprayed

  bool operator==(const Stand&) const = default;
};

struct Event {
  enum class Kind : std::uint8_t {
    kTick,     ///< time passes
    kConfirm,  ///< the operator has completed `step`
    kAtDepth,  ///< the descent has reached the depth
    kRising,   ///< the retraction has begun
    /// The motion is complete: the rise in step CLEAR, or the whole dip from descent to retraction.
    kMotionDone,
    kMotionStopped,  ///< the motion was stopped on request
    kMotionFailed,   ///< the motion failed
    kPlaceLost,      ///< at rest, the rig lost its reference or its torque
    kOrderRefused,   ///< the rig refused the last action
    kAtRest,  ///< after the ending was decided: the axis is at rest, or waiting for that timed out
    kCancel,
    kShutdown,  ///< the daemon shuts down
  };
  Kind kind = Kind::kTick;
  double time_s = 0;
  Step step = Step::kPrintFilm;  ///< the confirmed step, for kConfirm
  double position_mm = 0;        ///< axis position; for kTick and kConfirm
};

/// The action that the rig must perform next.
enum class Action : std::uint8_t {
  kNone,
  kRise,  ///< up to the clearance above first contact
  kDip,   ///< descent, hold, retraction
  kStop,
};

struct Outcome {
  Stand next;
  Action action = Action::kNone;
  bool refused = false;  ///< for kConfirm: the step cannot be confirmed now; the state is unchanged
};

/// Computes the next state and action after an event. Every event is valid in every state. Rules:
/// - Steps follow one another in order; none is skipped.
/// - A step that waits for the operator ends only by confirmation (or Clocks::skip). A step with a
///   clock ends when its time is over, a step with a motion when the motion is complete. Confirming
///   an earlier step changes nothing.
/// - A motion starts only when FIND_CONTACT or START_DIP is confirmed (or Clocks::skip is set).
/// - Once the ending is decided, the dip starts no motion and the ending does not change. The dip
///   is over when the axis is at rest.
/// - A film past its activation window causes a warning, never an error.
[[nodiscard]] Outcome proceed(const Stand& stand, const Event& event, const Clocks& clocks);

}  // namespace hydroprint::dip
