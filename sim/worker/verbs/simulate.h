#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Computes the film image to print from a textured model.
[[nodiscard]] Verb simulate_verb();

}  // namespace hydroprint::worker
