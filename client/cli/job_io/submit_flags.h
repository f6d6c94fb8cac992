#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "client/cli/program/program.h"
#include "client/jobs.h"

namespace hydroprint::cli {

/// The flags of `submit VERB` and `preview`; those of the worker under their own names.
struct SubmitOptions {
  client::Spec spec;  ///< what needs no upload goes here at once
  std::string mesh, texture, film_image, motion, points, profile, ink_image, pose, film,
      icc_profile, simulate_job, calibration;
  std::optional<std::string> depth;
};

/// Adds the flags of options.spec.verb.
void add_spec_flags(CLI::App& command, SubmitOptions& options);

/// Adds those that a preview heeds.
void add_preview_flags(CLI::App& command, SubmitOptions& options);

/// Uploads the files that they name.
[[nodiscard]] Result<client::Spec> upload_inputs(Program& program, const SubmitOptions& options);

}  // namespace hydroprint::cli
