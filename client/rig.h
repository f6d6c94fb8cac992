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

/// The state of the rig; hardware/rig/README.md draws the transitions.
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

/// "OFFLINE", "DISARMED", ... as in the API; "UNKNOWN" for values that this client does not know.
[[nodiscard]] std::string_view name_of(RigState state);

/// The outcome of a motion.
enum class MotionOutcome { kUnknown, kRunning, kDone, kStopped, kFailed };

/// "RUNNING", "DONE", ... as in the API.
[[nodiscard]] std::string_view name_of(MotionOutcome outcome);

/// One motion; the fields are those of the API's Motion.
struct Motion {
  std::uint64_t number = 0;  ///< counts up from 1 since the daemon started
  std::string kind;          ///< "HOME", "MOVE", "JOG", "DIP"
  MotionOutcome outcome = MotionOutcome::kUnknown;
  std::string cause;     ///< why it failed
  bool at_rest = false;  ///< the axis has been seen at standstill since the motion ended
  double begin_mm = 0;
  double end_mm = 0;
};

/// The configuration of the axis.
struct Axis {
  std::string drive;
  bool is_virtual = false;
  double min_mm = 0;  ///< soft limits
  double max_mm = 0;
  double max_speed_mm_per_s = 0;
  double stopping_distance_mm = 0;
  double watchdog_s = 0;  ///< 0: not read yet
};

/// Quality of the link to the drive, since the daemon started.
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
  std::string cause;    ///< why a reset is required; empty: no fault
  std::string trouble;  ///< one line: fault and remedy; empty: no fault
  bool homed = false;
  bool stop_button = false;
  bool enabled = false;
  std::optional<double> position_mm;
  std::optional<double> velocity_mm_per_s;
  int alarm_code = 0;
  std::string alarm_text;
  std::optional<Time> sample_time;
  std::optional<Motion> motion;  ///< the latest
  std::optional<Axis> axis;      ///< nullopt if no drive is configured
  LinkQuality link_quality;
  std::optional<Lease> lease;  ///< nullopt: nobody holds it
  std::string dip;             ///< the unfinished dip, "jobs/7"; empty: none
};

[[nodiscard]] Result<Rig> get_rig(Connection& connection);

/// Reports the rig's state at once and after every change, until `update` returns false.
/// @param max_rate_hz  0.1 to 10
/// @return kUnavailable when the stream breaks; call it again to continue
[[nodiscard]] Status watch_rig(Connection& connection, double max_rate_hz,
                               const std::function<bool(const Rig&)>& update);

// The functions below command the rig with the lease's id. Each request is sent once: if the answer
// is lost (kUnavailable), the command may have taken effect. Errors have RigService's reasons.

/// Enables the drive's torque.
[[nodiscard]] Result<Rig> arm_rig(Connection& connection, const std::string& lease_id);

/// Disables the torque. The position of the axis is unknown afterwards.
[[nodiscard]] Result<Rig> disarm_rig(Connection& connection, const std::string& lease_id);

/// Starts homing. @return as soon as it has begun; Rig.motion is this motion
[[nodiscard]] Result<Rig> home_rig(Connection& connection, const std::string& lease_id);

/// Starts a move. @return as soon as it has begun; Rig.motion is this motion
[[nodiscard]] Result<Rig> move_rig(Connection& connection, const std::string& lease_id,
                                   double position_mm, std::optional<double> speed_mm_per_s);

/// Jogs the axis as long as it is called again within 250 ms; positive is down.
[[nodiscard]] Result<Rig> jog_rig(Connection& connection, const std::string& lease_id,
                                  double speed_mm_per_s);

/// Clears the drive's alarm after FAULT or ESTOPPED. Does not start a motion.
[[nodiscard]] Result<Rig> reset_rig(Connection& connection, const std::string& lease_id);

/// Stops any motion. Needs no lease, is harmless when nothing moves, and is retried if necessary.
[[nodiscard]] Result<Rig> stop_rig(Connection& connection);

}  // namespace hydroprint::client
