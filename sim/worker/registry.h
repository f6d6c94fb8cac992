#pragma once

#include <vector>

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// All verbs of the program, in the order of its help text.
[[nodiscard]] std::vector<Verb> verbs();

}  // namespace hydroprint::worker
