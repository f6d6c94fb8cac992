#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Predicts the colours of an object dipped through a printed film image. Writes landed.ply,
/// landed.png for models with texture coordinates, and predicted.png. With `--artifacts map`,
/// writes only surface_map.ply.
[[nodiscard]] Verb predict_verb();

}  // namespace hydroprint::worker
