#pragma once

#include <string>
#include <vector>

#include "client/cli/job_io/wait.h"
#include "client/cli/program/program.h"
#include "client/job.h"

namespace hydroprint::cli {

/// Options for a job that a command has created.
struct FinishOptions {
  std::string out;       ///< folder for its artifacts; empty: no download
  bool no_wait = false;  ///< only print the job's name
  WaitOptions wait;
  std::vector<std::string> artifacts;  ///< names of the artifacts to download; empty: all
};

/// Adds --out, --no-wait and --cancel-on-interrupt.
void add_finish_flags(CLI::App& command, FinishOptions& options);

/// Prints the name of a new job.
void tell_created(const Program& program, const v1::Job& job);

/// Reports that a job passed --validate-only.
void tell_valid(const Program& program, const v1::Job& job);

/// Prints a job's name, waits until it is finished, and downloads its artifacts, as the options
/// say.
[[nodiscard]] Status finish_job(Program& program, const v1::Job& job, const FinishOptions& options);

/// Prints the warnings in the report of a job that succeeded to standard error; nothing if it has
/// no report.
[[nodiscard]] Status tell_warnings(Program& program, const std::string& job);

}  // namespace hydroprint::cli
