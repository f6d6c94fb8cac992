#pragma once

#include <cstdint>
#include <optional>

#include "hardware/drive/drive.h"
#include "hardware/rig/command_queue.h"
#include "hardware/rig/config.h"

namespace hydroprint::rig {

/// Checks an order before it is carried out, apart from the state of the rig.
/// @param stops  how many stops have been asked for until now
/// @param axis   the latest look at the axis; nullopt if there was none
/// @return kAborted, STATE_FORBIDS if a stop came after the order or it has waited too long (1 s;
/// for
///   a jog, the time for which a key counts as held); LIMIT_EXCEEDED for a motion beyond the limits
[[nodiscard]] Status check_order(const Order& order, std::uint64_t stops, const RigConfig& config,
                                 const drive::DriveProfile& profile,
                                 const std::optional<drive::DriveState>& axis);

/// kAborted, STATE_FORBIDS: the order was not carried out.
[[nodiscard]] tl::unexpected<Error> aborted(const std::string& why);

/// The error of a command after which something may have moved: with a code that clients do not
/// retry by themselves.
[[nodiscard]] Error after_start(Error error);

}  // namespace hydroprint::rig
