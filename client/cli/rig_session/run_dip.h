#pragma once

#include <string>

#include "client/cli/program/program.h"
#include "client/jobs.h"

namespace hydroprint::cli {

/// Options of a dip that a command carries out.
struct DipOptions {
  v1::DipSpec spec;
  client::JobOptions job;
  std::string out;        ///< folder for the dip's record; empty: no download
  bool no_guide = false;  ///< only create the dip, and keep the lease
};

/// Creates a dip under the lease, which is acquired unless the user has it. Guides the person at
/// the terminal through its steps, and prints the result. Ctrl-C aborts the dip.
/// @return kInvalidArgument without a terminal, unless the spec or the options need none; the
///         reason if the dip did not succeed
[[nodiscard]] Status run_dip(Program& program, const DipOptions& options);

/// Goes on with an unfinished dip like run_dip(). A dip that needs no confirmations is only
/// followed, without the lease.
/// @param options  `spec` and `job` are not used
[[nodiscard]] Status resume_dip(Program& program, const std::string& job, DipOptions options);

}  // namespace hydroprint::cli
