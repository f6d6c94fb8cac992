#pragma once

#include <Eigen/Core>
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "hardware/simulator/scene/scenery.h"
#include "sim/base/result.h"

namespace hydroprint::simulated_drive {

/// What can be wrong with one reply.
enum class ReplyFaultKind {
  kNone,
  kLate,           ///< comes `delay` later
  kDrop,           ///< never comes
  kTruncate,       ///< half of it comes
  kWrongId,        ///< from another unit
  kWrongFunction,  ///< for another function
  kWrongCrc,       ///< RTU: checksum; TCP: transaction id
  kWrongLength,    ///< well framed, but a word short; of a write: repeats another value
  kBusy,           ///< exception 6; the request is not obeyed
  kDeaf,           ///< the request is not even heard
};

/// A fault and how many replies it strikes.
struct ReplyFault {
  ReplyFaultKind fault = ReplyFaultKind::kNone;
  std::chrono::milliseconds delay{0};
  int count = 1;  ///< negative: until cleared
};

/// Something to do to the rig.
struct Action {
  enum class Kind {
    kReplyFault,
    kClear,    ///< no more faults, nothing pressed, stalled or frozen
    kPress,    ///< `input`
    kRelease,  ///< `input`
    kUnplug,
    kReplug,
    kReboot,  ///< silent for `pause`, then switched on
    kCamera,  ///< becomes `camera`
    kMarker,  ///< that of name `name` becomes `marker`
    kPush,    ///< the marker `name` by `push_mm`
    kHang,    ///< the object, or another `mesh`, hangs as the pose file `name` says
    kShow,    ///< `mesh` is held before the camera as the pose file `name` says; none: nothing
    kState,
    kScenery,  ///< for the camera's driver: what there is to see, and what of it changes
    kSight,
    kHelp,
  };
  enum class Input { kStopButton, kPositiveEnd, kNegativeEnd, kStall, kFreeze };
  Kind kind = Kind::kState;
  ReplyFault reply_fault;
  Input input = Input::kStopButton;
  std::chrono::milliseconds pause{0};
  simulated_scene::CameraState camera = simulated_scene::CameraState::kWell;
  simulated_scene::MarkerState marker = simulated_scene::MarkerState::kWell;
  Eigen::Vector2d push_mm{0, 0};
  std::string name = {};
  std::string mesh = {};
};

/// Reads one line of the control socket: "fault late 700ms 3", "press stop", "reboot 2s", ...
/// A name with blanks in it stands in double quotes.
/// Refuses anything else with kInvalidArgument, saying what there is.
[[nodiscard]] Result<Action> parse_action(std::string_view line);

/// An action at a time after the start.
struct TimedAction {
  std::chrono::milliseconds at{0};
  Action action;
};

/// Reads the value of --fault: actions with commas between, "=" for blanks, "@TIME" behind:
/// "late=700ms@5s,press=stop@8s".
[[nodiscard]] Result<std::vector<TimedAction>> parse_timed_actions(std::string_view text);

/// What there is to say on a control line, for people.
[[nodiscard]] std::string_view action_help();

}  // namespace hydroprint::simulated_drive
