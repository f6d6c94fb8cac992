#pragma once

#include <vector>

#include "sim/worker/options.h"
#include "sim/worker/progress.h"

namespace hydroprint::worker {

/// The stages that a run goes through, in their order and as often as they come, each with its
/// rough share of the whole, for a time left that is believable; how it is in truth depends on the
/// job. A run may leave stages out: ink passes end once the film has come to rest, and a model
/// without colours has none.
[[nodiscard]] std::vector<Stage> stages(const Options& options);

}  // namespace hydroprint::worker
