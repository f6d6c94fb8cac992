#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "client/cli/program/program.h"
#include "client/jobs.h"

namespace hydroprint::cli {

/// The flags of `submit VERB` and `preview`. Flags of the worker keep their names.
struct SubmitOptions {
  client::Spec spec;  ///< flags that need no upload are stored here directly
  std::string mesh, texture, film_image, motion, points, profile, ink_image, pose, film,
      icc_profile, simulate_job, calibration;
  std::optional<std::string> depth;
};

/// Adds the flags for options.spec.verb.
void add_spec_flags(CLI::App& command, SubmitOptions& options);

/// Adds the flags used by a preview.
void add_preview_flags(CLI::App& command, SubmitOptions& options);

/// Uploads the files given by the flags.
[[nodiscard]] Result<client::Spec> upload_inputs(Program& program, const SubmitOptions& options);

}  // namespace hydroprint::cli
