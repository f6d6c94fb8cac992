#pragma once

#include "client/cli/program/program.h"
#include "hydroprint/v1/job.pb.h"
#include "sim/base/pose.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// Waits for a job without showing progress.
/// @return the job if it succeeded, otherwise the error
[[nodiscard]] Result<v1::Job> finish_quietly(Program& program, const v1::Job& job);

/// Queues a job and waits for it like finish_quietly().
[[nodiscard]] Result<v1::Job> run_quietly(Program& program, const v1::Job& job);

/// Captures frames with the daemon's camera and waits like finish_quietly().
[[nodiscard]] Result<v1::Job> capture_quietly(Program& program, double seconds);

/// These functions convert a pose to and from the API's message. All numbers of the message must be
/// set.
[[nodiscard]] v1::Pose message_of(const Pose& pose);
[[nodiscard]] Pose pose_of(const v1::Pose& message);

}  // namespace hydroprint::cli
