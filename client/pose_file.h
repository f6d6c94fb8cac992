#pragma once

#include <filesystem>

#include "client/job.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// Reads the worker's `--pose` file as the worker does; refuses what it would refuse.
[[nodiscard]] Result<PoseSpec> read_pose_file(const std::filesystem::path& path);

}  // namespace hydroprint::client
