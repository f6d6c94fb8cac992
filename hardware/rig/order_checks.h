#pragma once

#include <cstdint>
#include <optional>

#include "hardware/drive/drive.h"
#include "hardware/rig/command_queue.h"
#include "hardware/rig/config.h"

namespace hydroprint::rig {

/// Checks an order before execution. Does not check whether the state of the rig permits it.
/// @param stops  number of stops requested so far
/// @param axis   the latest sample of the axis; nullopt if there is none
/// @return kAborted, reason STATE_FORBIDS, if a stop was requested after the order, or if the order
///         has waited too long (1 s; for a jog, the time for which a key counts as held);
///         reason LIMIT_EXCEEDED for a motion beyond the limits
[[nodiscard]] Status check_order(const Order& order, std::uint64_t stops, const RigConfig& config,
                                 const drive::DriveProfile& profile,
                                 const std::optional<drive::DriveState>& axis);

/// Returns the error for an order that was not executed: kAborted, reason STATE_FORBIDS.
[[nodiscard]] tl::unexpected<Error> aborted(const std::string& why);

/// Converts the error of a command that may have started a motion to a code that clients do not
/// retry automatically.
[[nodiscard]] Error after_start(Error error);

}  // namespace hydroprint::rig
