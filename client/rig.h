#pragma once

#include <functional>
#include <optional>
#include <string>

#include "client/connection/connection.h"
#include "hydroprint/v1/rig.pb.h"
#include "sim/base/result.h"

namespace hydroprint::client {

[[nodiscard]] Result<v1::Rig> get_rig(Connection& connection);

/// Reports the rig's state immediately and after changes, until `update` returns false.
/// @param max_rate_hz  maximum number of reports per second, 0.1 to 10
/// @return kUnavailable when the stream breaks; call this again to continue
[[nodiscard]] Status watch_rig(Connection& connection, double max_rate_hz,
                               const std::function<bool(const v1::Rig&)>& update);

// Except for stop_rig(), the functions below command the rig and need the id of the lease. Each of
// their requests is sent once: if the response is lost (kUnavailable), the command may have taken
// effect. RigService documents the reasons of their errors.

/// Enables the drive's torque.
[[nodiscard]] Result<v1::Rig> arm_rig(Connection& connection, const std::string& lease_id);

/// Disables the torque. The position of the axis is unknown afterwards.
[[nodiscard]] Result<v1::Rig> disarm_rig(Connection& connection, const std::string& lease_id);

/// Starts homing and returns without waiting for its end. Rig.motion of the result describes this
/// motion.
[[nodiscard]] Result<v1::Rig> home_rig(Connection& connection, const std::string& lease_id);

/// Starts a move and returns without waiting for its end. Rig.motion of the result describes this
/// motion.
[[nodiscard]] Result<v1::Rig> move_rig(Connection& connection, const std::string& lease_id,
                                       double position_mm, std::optional<double> speed_mm_per_s);

/// Jogs the axis, downwards if the speed is positive. The axis stops unless this is called again
/// within 250 ms.
[[nodiscard]] Result<v1::Rig> jog_rig(Connection& connection, const std::string& lease_id,
                                      double speed_mm_per_s);

/// Clears the drive's alarm when the rig's state is FAULT or ESTOPPED. Does not start a motion.
[[nodiscard]] Result<v1::Rig> reset_rig(Connection& connection, const std::string& lease_id);

/// Stops any motion. Needs no lease, has no effect at standstill, and is retried if necessary.
[[nodiscard]] Result<v1::Rig> stop_rig(Connection& connection);

}  // namespace hydroprint::client
