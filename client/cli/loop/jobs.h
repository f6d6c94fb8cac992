#pragma once

#include "client/cli/program/program.h"
#include "client/job.h"
#include "sim/base/pose.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// Follows a job to its end, without showing it. @return it if it succeeded; why not otherwise
[[nodiscard]] Result<client::Job> finish_quietly(Program& program, const client::Job& job);

/// Queues a job, and follows it as above.
[[nodiscard]] Result<client::Job> run_quietly(Program& program, const client::Spec& spec);

/// Takes frames of the daemon's camera, as above.
[[nodiscard]] Result<client::Job> capture_quietly(Program& program, double seconds);

/// A pose as specs have it, and back.
[[nodiscard]] client::PoseSpec spec_of(const Pose& pose);
[[nodiscard]] Pose pose_of(const client::PoseSpec& spec);

}  // namespace hydroprint::cli
