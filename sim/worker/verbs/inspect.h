#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Reads a model and writes how it was understood: model.glb for display, and report.json, a
/// v1::ModelSummary. See inspect_model().
[[nodiscard]] Verb inspect_verb();

}  // namespace hydroprint::worker
