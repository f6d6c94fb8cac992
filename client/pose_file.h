#pragma once

#include <filesystem>

#include "hydroprint/v1/spec.pb.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// Reads a `--pose` file with the same rules as the worker.
[[nodiscard]] Result<v1::Pose> read_pose_file(const std::filesystem::path& path);

}  // namespace hydroprint::client
