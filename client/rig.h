#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "client/connection/connection.h"
#include "client/lease.h"
#include "client/time.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// What the rig is doing; hardware/rig/README.md draws how one follows another.
enum class RigState {
  kUnknown,
  kOffline,
  kDisarmed,
  kUnhomed,
  kIdle,
  kMoving,
  kDipping,
  kStopping,
  kFault,
  kEstopped
};

/// "OFFLINE", "DISARMED", ... as in the API; "UNKNOWN" for what this client does not know.
[[nodiscard]] std::string_view name_of(RigState state);

/// What became of a motion.
enum class MotionOutcome { kUnknown, kRunning, kDone, kStopped, kFailed };

/// "RUNNING", "DONE", ... as in the API.
[[nodiscard]] std::string_view name_of(MotionOutcome outcome);

/// One motion; the fields are those of the API's Motion.
struct Motion {
  std::uint64_t number = 0;  ///< counts up from 1 since the daemon started
  std::string kind;          ///< "HOME", "MOVE", "JOG", "DIP"
  MotionOutcome outcome = MotionOutcome::kUnknown;
  std::string cause;     ///< why it failed
  bool at_rest = false;  ///< the axis was seen at rest since it ended
  double begin_mm = 0;
  double end_mm = 0;
};

/// What the configuration says of the axis.
struct Axis {
  std::string drive;
  bool is_virtual = false;
  double min_mm = 0;  ///< soft limits
  double max_mm = 0;
  double max_speed_mm_per_s = 0;
  double stopping_distance_mm = 0;
  double watchdog_s = 0;  ///< 0: not read yet
};

/// How well the drive answers, since the daemon started.
struct LinkQuality {
  std::uint64_t missed_polls = 0;
  std::uint64_t connects = 0;
  std::uint64_t polls = 0;
  std::uint64_t skipped_polls = 0;
  double largest_lateness_s = 0;
  double rms_lateness_s = 0;
};

/// The rig as the daemon describes it; the fields are those of the API's Rig. Positions are the
/// drive's: 0 at home, positive is down.
struct Rig {
  RigState state = RigState::kUnknown;
  std::string cause;    ///< why it wants a reset; empty: nothing is wrong
  std::string trouble;  ///< one line: what is wrong and what to do; empty if nothing is
  bool homed = false;
  bool stop_button = false;
  bool enabled = false;
  std::optional<double> position_mm;
  std::optional<double> velocity_mm_per_s;
  int alarm_code = 0;
  std::string alarm_text;
  std::optional<Time> sample_time;
  std::optional<Motion> motion;  ///< the latest
  std::optional<Axis> axis;      ///< none if no drive is configured
  LinkQuality link_quality;
  std::optional<Lease> lease;  ///< none: nobody has it
  std::string dip;             ///< the dip that is not finished, "jobs/7"; empty: none
};

[[nodiscard]] Result<Rig> get_rig(Connection& connection);

/// Tells the rig as it stands, then whenever it changes, until `update` returns false.
/// @param max_rate_hz  0.1 to 10
/// @return kUnavailable when the stream breaks; call it again to go on
[[nodiscard]] Status watch_rig(Connection& connection, double max_rate_hz,
                               const std::function<bool(const Rig&)>& update);

// What follows commands the rig, each with the lease's id, and is sent once: if the answer is lost
// (kUnavailable) the command may have been obeyed. Refusals are RigService's, by their reasons.

/// Gives the drive torque.
[[nodiscard]] Result<Rig> arm_rig(Connection& connection, const std::string& lease_id);

/// Takes the torque away; where the axis is, is not known afterwards.
[[nodiscard]] Result<Rig> disarm_rig(Connection& connection, const std::string& lease_id);

/// Starts to look for the home switch. @return once it began; Rig.motion is this motion
[[nodiscard]] Result<Rig> home_rig(Connection& connection, const std::string& lease_id);

/// Starts to go to a place. @return once it began; Rig.motion is this motion
[[nodiscard]] Result<Rig> move_rig(Connection& connection, const std::string& lease_id,
                                   double position_mm, std::optional<double> speed_mm_per_s);

/// Moves for as long as it is called again at least every 250 ms; positive is down.
[[nodiscard]] Result<Rig> jog_rig(Connection& connection, const std::string& lease_id,
                                  double speed_mm_per_s);

/// After FAULT or ESTOPPED: clears the drive's alarm. Starts nothing.
[[nodiscard]] Result<Rig> reset_rig(Connection& connection, const std::string& lease_id);

/// Stops any motion; needs no lease, does no harm when nothing moves, and is sent again if it must.
[[nodiscard]] Result<Rig> stop_rig(Connection& connection);

}  // namespace hydroprint::client
