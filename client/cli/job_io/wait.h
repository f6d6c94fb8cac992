#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "client/artifacts.h"
#include "client/cli/program/program.h"
#include "client/jobs.h"

namespace hydroprint::cli {

/// Options for waiting for a job.
struct WaitOptions {
  bool cancel_on_interrupt = false;  ///< Ctrl-C cancels the job; otherwise the job continues
  bool json_lines = false;           ///< every update as a line of JSON on standard output
  int descriptor = 2;                ///< destination of the display otherwise
};

/// Adds --cancel-on-interrupt.
void add_wait_flags(CLI::App& command, WaitOptions& options);

/// Waits until a job is finished. @return the job if it succeeded; kInvalidArgument if it failed
/// because of its input, kInternal if it failed otherwise, kCancelled if it was cancelled or on
/// Ctrl-C
[[nodiscard]] Result<v1::Job> wait_for(Program& program, const std::string& job,
                                       const WaitOptions& options);

/// Waits until a job is finished and shows its progress. @return the finished job, successful or
/// not; kCancelled on Ctrl-C
[[nodiscard]] Result<v1::Job> follow_job(Program& program, const std::string& job,
                                         const WaitOptions& options);

/// Explains why a finished job did not succeed; for a dip, also what to do with film and object.
[[nodiscard]] Error why(const v1::Job& job);

/// A downloaded file.
struct Downloaded {
  std::filesystem::path path;
  v1::Artifact artifact;
};

/// Downloads the named artifacts of a job into `folder`; all artifacts if `names` is empty.
[[nodiscard]] Result<std::vector<Downloaded>> download_all(client::Connection& daemon,
                                                           const std::string& job,
                                                           const std::vector<std::string>& names,
                                                           const std::filesystem::path& folder);

/// Returns an array of the artifacts, each with the "path" of its file.
[[nodiscard]] nlohmann::ordered_json files_json(const std::vector<Downloaded>& files);

}  // namespace hydroprint::cli
