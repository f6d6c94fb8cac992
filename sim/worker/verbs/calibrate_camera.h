#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Finds the lens and the depth scale of a camera. Writes camera.json.
[[nodiscard]] Verb calibrate_camera_verb();

}  // namespace hydroprint::worker
