#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Predicts the colours of an object dipped through a printed film image: landed.ply, landed.png
/// for models with texture coordinates, and predicted.png.
[[nodiscard]] Verb predict_verb();

}  // namespace hydroprint::worker
