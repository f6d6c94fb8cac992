#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Predicts the colours that a printed film image leaves on the object: landed.ply, landed.png for
/// models with texture coordinates, and predicted.png.
[[nodiscard]] Verb predict_verb();

}  // namespace hydroprint::worker
