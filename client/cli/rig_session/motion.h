#pragma once

#include "client/cli/program/program.h"
#include "client/rig.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// Follows the motion that a command started until the axis is at standstill, and shows it on
/// standard error. Ctrl-C stops the axis, even while the command is still being sent.
/// @param begun  the daemon's response to the command
/// @return the rig if the motion reached its target; kAborted if it was stopped, kInternal if it
///         failed, kCancelled on Ctrl-C, kUnavailable if the daemon is lost
[[nodiscard]] Result<v1::Rig> wait_for_motion(Program& program, Result<v1::Rig> begun);

/// Waits for up to two seconds until the axis is at standstill. Not affected by Ctrl-C.
[[nodiscard]] Result<v1::Rig> wait_for_rest(const Program& program);

/// Stops the axis and waits like wait_for_rest().
[[nodiscard]] Result<v1::Rig> stop_and_wait(const Program& program);

}  // namespace hydroprint::cli
