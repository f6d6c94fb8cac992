#pragma once

#include "client/cli/program/program.h"
#include "client/rig.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// Follows the motion that `begun` tells of until the axis is at rest, and shows it on standard
/// error. Ctrl-C stops the axis, also if it comes while the order is under way.
/// @param begun  the daemon's answer to the order
/// @return the rig if the motion got where it was to go; kAborted if it was stopped, kInternal if
/// it
///   failed, kCancelled on Ctrl-C, kUnavailable if the daemon is lost
[[nodiscard]] Result<client::Rig> wait_for_motion(Program& program, Result<client::Rig> begun);

/// Waits for up to two seconds until the axis is at rest. Not ended by Ctrl-C.
[[nodiscard]] Result<client::Rig> wait_for_rest(const Program& program);

/// Stops the axis, and waits as above.
[[nodiscard]] Result<client::Rig> stop_and_wait(const Program& program);

}  // namespace hydroprint::cli
