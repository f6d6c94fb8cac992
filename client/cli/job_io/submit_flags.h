#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/cli/program/program.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::cli {

/// The flags of `submit VERB` and `preview`. Flags of the worker keep their names.
struct SubmitOptions {
  v1::Job job;  ///< flags that need no upload are stored in its spec directly
  std::string mesh, pose, film;
  std::optional<std::string> depth;
  std::vector<std::pair<std::string, std::string>> files;  ///< field of the spec, and path
};

/// Adds the flags for the kind of options.job.
void add_spec_flags(CLI::App& command, SubmitOptions& options);

/// Adds the flags used by a preview.
void add_preview_flags(CLI::App& command, SubmitOptions& options);

/// Uploads the files given by the flags. @return the job with its whole spec
[[nodiscard]] Result<v1::Job> upload_inputs(Program& program, const SubmitOptions& options);

}  // namespace hydroprint::cli
