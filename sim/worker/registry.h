#pragma once

#include <vector>

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Returns all verbs of the program, by name. The build lists them from the folder verbs/.
[[nodiscard]] std::vector<Verb> verbs();

}  // namespace hydroprint::worker
