#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace hydroprint::dip {

/// The steps of a dip in their order; numbers and meanings are those of
/// hydroprint.v1.DipStatus.Step.
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

/// "FIND_CONTACT".
[[nodiscard]] std::string_view name(Step step);

/// What a step waits for.
enum class Awaits : std::uint8_t { kOperator, kClock, kMotion };
[[nodiscard]] Awaits awaits(Step step);

/// True from the first motion on: the rig must keep its place, and nobody else may move it.
[[nodiscard]] constexpr bool has_the_rig(Step step) { return step >= Step::kClear; }

/// How long the clocks run, s.
struct Clocks {
  double soak_s = 60;
  double activator_wait_s = 20;
  double activation_window_s = 60;  ///< after the wait, for as long as the film is good
  bool skip = false;                ///< no confirmations and no clocks: nobody is there
};

/// How a dip ends.
enum class Ending : std::uint8_t { kNone, kSucceeded, kFailed, kCancelled, kInterrupted };
[[nodiscard]] std::string_view name(Ending ending);  ///< "SUCCEEDED"; "" of kNone

/// Where a dip stands. Times are seconds since it was created.
struct Stand {
  Step step = Step::kPrintFilm;
  double since_s = 0;                ///< when the step began
  Ending ending = Ending::kNone;     ///< decided; the axis may still have to come to rest
  double ending_s = 0;               ///< when that was
  bool over = false;                 ///< nothing more will happen
  bool late = false;                 ///< the film was activated longer ago than it is good
  std::optional<double> loaded_mm;   ///< where the axis was when the object was loaded
  std::optional<double> contact_mm;  ///< where it was at first contact
  std::optional<double> sprayed_s;   ///< when the activator was sprayed

  bool operator==(const Stand&) const = default;
};

struct Event {
  enum class Kind : std::uint8_t {
    kTick,           ///< time goes by
    kConfirm,        ///< the operator has done `step`
    kAtDepth,        ///< of the descent: the axis has arrived
    kRising,         ///< and has begun the way up
    kMotionDone,     ///< the motion of this step (or of all steps from the descent on)
    kMotionStopped,  ///< somebody asked for it
    kMotionFailed,   ///< something went wrong
    kPlaceLost,      ///< at rest, the rig lost its place or its torque
    kOrderRefused,   ///< what the last action asked for was refused
    kAtRest,         ///< after the end was decided: seen at rest, or nothing more can be done
    kCancel,
    kShutdown,  ///< the daemon goes down
  };
  Kind kind = Kind::kTick;
  double time_s = 0;
  Step step = Step::kPrintFilm;  ///< of kConfirm
  double position_mm = 0;        ///< of kTick and kConfirm: where the axis is
};

/// What the rig must do.
enum class Action : std::uint8_t {
  kNone,
  kRise,  ///< to the clearance above first contact
  kDip,   ///< descent, hold, retraction
  kStop,
};

struct Outcome {
  Stand next;
  Action action = Action::kNone;
  bool refused = false;  ///< of kConfirm: the dip waits for something else; `next` is as before
};

/// What follows from an event; every event is good in every stand. Rules:
/// - steps follow one another in their order, and none is left out;
/// - what waits for the operator is left by the confirmation alone (or Clocks::skip), a clock when
/// its
///   time is over, a motion when it is done; to confirm a step that is past changes nothing;
/// - nothing moves but by the confirmations of FIND_CONTACT and START_DIP;
/// - once its end is decided a dip moves nothing any more, and its end does not change; it is over
///   when the axis is at rest;
/// - a film that is past its window is told, never refused.
[[nodiscard]] Outcome proceed(const Stand& stand, const Event& event, const Clocks& clocks);

}  // namespace hydroprint::dip
