#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Runs the paper's experiments in silico. Writes report.html and its pictures.
[[nodiscard]] Verb validate_verb();

}  // namespace hydroprint::worker
