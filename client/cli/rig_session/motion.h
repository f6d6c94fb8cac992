#pragma once

#include "client/cli/program/program.h"
#include "client/cli/rig_session/stop_alarm.h"
#include "client/rig.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// Follows the motion that a command started until the axis is at standstill, and shows it on
/// standard error. Ctrl-C stops the axis, even while the command is still being sent. A stop that
/// the drive does not obey, also another client's, is told at once and ends the wait.
/// @param begun  the daemon's response to the command
/// @return the rig if the motion reached its target; kAborted if it was stopped, kInternal if it
///         failed or a stop is not obeyed, kCancelled on Ctrl-C, kUnavailable if the daemon is lost
[[nodiscard]] Result<v1::Rig> wait_for_motion(Program& program, Result<v1::Rig> begun);

/// Waits for up to two seconds until the axis is at standstill, or does not obey a stop; `alarm`
/// tells the latter. Not affected by Ctrl-C.
[[nodiscard]] Result<v1::Rig> wait_for_rest(const Program& program, StopAlarm& alarm);

/// Stops the axis and waits like wait_for_rest().
[[nodiscard]] Result<v1::Rig> stop_and_wait(const Program& program, StopAlarm& alarm);

}  // namespace hydroprint::cli
