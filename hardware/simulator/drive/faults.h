#pragma once

#include <Eigen/Core>
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "hardware/simulator/scene/scenery.h"
#include "sim/base/result.h"

namespace hydroprint::simulated_drive {

/// A fault in a reply.
enum class ReplyFaultKind {
  kNone,
  kLate,           ///< arrives `delay` later
  kDrop,           ///< never arrives
  kDouble,         ///< arrives twice
  kOvertaken,      ///< arrives directly before the third reply that follows
  kTruncate,       ///< only half arrives
  kWrongId,        ///< reply of another unit
  kWrongFunction,  ///< reply of another function
  kWrongCrc,       ///< RTU: checksum; TCP: transaction id
  kWrongLength,    ///< correctly framed, but one word short; for a write: confirms another value
  kBusy,           ///< exception 6; the request has no effect
  kDropRequest,    ///< the drive does not receive the request
};

/// A fault and the number of replies that it affects.
struct ReplyFault {
  ReplyFaultKind fault = ReplyFaultKind::kNone;
  std::chrono::milliseconds delay{0};
  int count = 1;             ///< negative: until cleared
  bool writes_only = false;  ///< begins at a write; only kDropRequest then goes on with reads
};

/// An action on the rig.
struct Action {
  enum class Kind {
    kReplyFault,
    kClear,    ///< clears all faults, including pressed, stalled and frozen inputs
    kPress,    ///< activates `input`
    kRelease,  ///< deactivates `input`
    kUnplug,
    kReplug,
    kReboot,     ///< silent for `pause`, then switched on
    kCamera,     ///< sets the state of the camera to `camera`
    kMarker,     ///< sets the state of the marker `name` to `marker`
    kPush,       ///< moves the marker `name` by `push_mm`
    kSetObject,  ///< sets the object's pose from file `name`; replaces the object if `mesh` is set
    kShow,       ///< shows only `mesh`, at the pose in the file `name`; if empty, shows the rig
    kState,
    kScenery,  ///< returns the fixed part of the scene, for the camera driver
    kSight,    ///< returns the variable part of the scene, for the camera driver
    kHelp,
  };
  enum class Input {
    kStopButton,
    kPositiveEnd,
    kNegativeEnd,
    kStall,
    kFreeze,
    kDeaf,
    kRunaway,
    kDrift
  };
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

/// Parses one line of the control socket: "fault late 700ms 3", "press stop", "reboot 2s", ...
/// Names with spaces must be in double quotes. Returns kInvalidArgument with the list of actions
/// for other text.
[[nodiscard]] Result<Action> parse_action(std::string_view line);

/// An action and its time, measured from the start of the rig.
struct TimedAction {
  std::chrono::milliseconds at{0};
  Action action;
};

/// Parses the value of --fault: actions separated by commas, with "=" for spaces and "@TIME" at the
/// end: "late=700ms@5s,press=stop@8s".
[[nodiscard]] Result<std::vector<TimedAction>> parse_timed_actions(std::string_view text);

/// Returns the help text for the actions of the control socket.
[[nodiscard]] std::string_view action_help();

}  // namespace hydroprint::simulated_drive
