#pragma once

#include <filesystem>

#include "sim/base/pose.h"
#include "sim/base/result.h"

namespace hydroprint::worker {

/// Reads {"rotation_wxyz": [w, x, y, z], "translation_mm": [x, y, z]} (contract, `--pose`); either
/// may be left out. The quaternion is normalised.
/// Refuses, naming file and key: unknown keys, lists of the wrong length, coordinates beyond 1e6
/// mm, a quaternion too short to have a direction.
[[nodiscard]] Result<Pose> read_pose(const std::filesystem::path& path);

}  // namespace hydroprint::worker
