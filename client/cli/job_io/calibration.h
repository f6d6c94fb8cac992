#pragma once

#include <optional>
#include <string>

#include "client/cli/job_io/finish.h"
#include "client/cli/job_io/wait.h"
#include "client/cli/program/program.h"
#include "client/jobs.h"

namespace hydroprint::cli {

/// Records frames with the daemon's camera, prints the job's name, and waits for it.
/// @param seconds  nullopt: the daemon's default
/// @return the capture job, "jobs/5"; errors: see wait_for()
[[nodiscard]] Result<std::string> capture_frames(Program& program, std::optional<double> seconds,
                                                 const WaitOptions& options);

/// Queues a calibrate or calibrate-camera job, follows it like finish_job(), and prints its
/// calibration.
[[nodiscard]] Status run_calibration(Program& program, const v1::Job& job,
                                     const client::JobOptions& job_options,
                                     const FinishOptions& options);

}  // namespace hydroprint::cli
