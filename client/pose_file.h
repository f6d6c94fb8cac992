#pragma once

#include <filesystem>

#include "client/job.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// Reads a `--pose` file by the same rules as the worker.
[[nodiscard]] Result<PoseSpec> read_pose_file(const std::filesystem::path& path);

}  // namespace hydroprint::client
