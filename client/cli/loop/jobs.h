#pragma once

#include "client/cli/program/program.h"
#include "client/job.h"
#include "sim/base/pose.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// Waits for a job without showing progress. @return the job if it succeeded, otherwise the error
[[nodiscard]] Result<client::Job> finish_quietly(Program& program, const client::Job& job);

/// Queues a job and waits for it in the same way.
[[nodiscard]] Result<client::Job> run_quietly(Program& program, const client::Spec& spec);

/// Captures frames with the daemon's camera and waits in the same way.
[[nodiscard]] Result<client::Job> capture_quietly(Program& program, double seconds);

/// Convert a pose to and from a spec.
[[nodiscard]] client::PoseSpec spec_of(const Pose& pose);
[[nodiscard]] Pose pose_of(const client::PoseSpec& spec);

}  // namespace hydroprint::cli
