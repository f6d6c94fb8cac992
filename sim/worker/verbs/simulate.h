#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// From a textured model to the film image to print.
[[nodiscard]] Verb simulate_verb();

}  // namespace hydroprint::worker
