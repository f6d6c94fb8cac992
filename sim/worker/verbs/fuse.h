#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Fuses the frames of a camera swept by hand. Writes scan.ply, scan.png and camera_path.csv.
[[nodiscard]] Verb fuse_verb();

}  // namespace hydroprint::worker
