#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// From a film image as printed to the colours that land on the object: landed.ply, landed.png for
/// models with texture coordinates, and predicted.png.
[[nodiscard]] Verb predict_verb();

}  // namespace hydroprint::worker
