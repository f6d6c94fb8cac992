#pragma once

#include <string>

#include "client/cli/job_io/wait.h"
#include "client/cli/program/program.h"
#include "client/job.h"

namespace hydroprint::cli {

/// What becomes of a job that a command has created.
struct FinishOptions {
  std::string out;       ///< folder for its artifacts; empty: none
  bool no_wait = false;  ///< it is only named
  WaitOptions wait;
};

/// Adds --out, --no-wait and --cancel-on-interrupt.
void add_finish_flags(CLI::App& command, FinishOptions& options);

/// Names a job that was created.
void tell_created(const Program& program, const client::Job& job);

/// Says that the daemon would take a job that was only to be checked.
void tell_valid(const Program& program, const client::Job& job);

/// Names a job, follows it to its end, and downloads what it made.
[[nodiscard]] Status finish_job(Program& program, const client::Job& job,
                                const FinishOptions& options);

}  // namespace hydroprint::cli
