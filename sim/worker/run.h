#pragma once

#include <filesystem>

#include "sim/base/result.h"
#include "sim/worker/ending.h"
#include "sim/worker/options.h"
#include "sim/worker/report.h"

namespace hydroprint::worker {

/// A run that is done: its artifact folder, and what report.json tells.
struct Finished {
  std::filesystem::path dir;
  Report report;
};

/// Does what the options ask: reads the inputs, computes and writes the artifact folder. Tells
/// progress on --progress-fd and, if that is a terminal, on `stderr_fd`. On failure nothing is
/// left.
[[nodiscard]] Result<Finished> run(const Options& options, Ending& ending, int stderr_fd);

}  // namespace hydroprint::worker
