#pragma once

#include "client/cli/program/program.h"
#include "client/cli/rig_session/held_lease.h"
#include "client/cli/rig_session/stop_alarm.h"
#include "hydroprint/v1/job.pb.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// Guides a person at a terminal through a dip. Shows each step with its instruction, timer and
/// warnings; Enter confirms a step. In the step FIND_CONTACT, the keys of `rig jog` move the axis.
/// @param job  the new dip
/// @param alarm  tells a stop that is not obeyed
/// @return the finished job, successful or not; kCancelled on Ctrl-C, while the dip still runs
[[nodiscard]] Result<v1::Job> guide(Program& program, const HeldLease& lease, v1::Job job,
                                    StopAlarm& alarm);

}  // namespace hydroprint::cli
