#pragma once

#include "client/cli/program/program.h"
#include "client/cli/rig_session/held_lease.h"
#include "client/job.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// Leads a person at a terminal through a dip: shows each step with its instruction, its clock and
/// the warnings; Enter confirms a step; where first contact is looked for, the keys of `rig jog`
/// move the axis.
/// @param job  the dip as it was created
/// @return the job as it ended, however it did; kCancelled on Ctrl-C, when the dip still goes on
[[nodiscard]] Result<client::Job> guide(Program& program, const HeldLease& lease, client::Job job);

}  // namespace hydroprint::cli
