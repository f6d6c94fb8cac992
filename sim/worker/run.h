#pragma once

#include "sim/base/result.h"
#include "sim/worker/ending.h"
#include "sim/worker/options.h"

namespace hydroprint::worker {

/// Does what the options ask: reads the inputs, computes, writes the artifact folder and sums up on
/// stdout. Tells progress on --progress-fd and on a terminal's stderr. On failure nothing is left.
[[nodiscard]] Status run(const Options& options, Ending& ending);

}  // namespace hydroprint::worker
