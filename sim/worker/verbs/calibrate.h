#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Finds the pose of the object in the film frame. Writes calibration.json, pose.json,
/// alignment.png and error.png.
[[nodiscard]] Verb calibrate_verb();

}  // namespace hydroprint::worker
