#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/cli/program/program.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::cli {

/// The flags of `submit VERB` and `preview`. They have the same names as the worker's flags.
struct SubmitOptions {
  v1::Job job;  ///< flags that need no upload are stored in its spec directly
  std::string mesh, pose, film;
  std::optional<std::string> depth;
  /// Field of the spec, and path of the file.
  std::vector<std::pair<std::string, std::string>> files;
};

/// Adds the flags for the kind of options.job.
void add_spec_flags(CLI::App& command, SubmitOptions& options);

/// Adds the flags used by a preview.
void add_preview_flags(CLI::App& command, SubmitOptions& options);

/// Uploads the files given by the flags. Returns the job with its complete spec.
[[nodiscard]] Result<v1::Job> upload_inputs(Program& program, const SubmitOptions& options);

}  // namespace hydroprint::cli
