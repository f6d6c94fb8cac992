#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// The experiments of the paper in silico: report.html and its pictures.
[[nodiscard]] Verb validate_verb();

}  // namespace hydroprint::worker
