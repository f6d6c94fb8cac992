#pragma once

#include <filesystem>

#include "client/job.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// Reads the worker's `--pose` file, {"rotation_wxyz":[w,x,y,z],"translation_mm":[x,y,z]}.
/// @return kInvalidArgument naming the file, the key and what belongs there
[[nodiscard]] Result<PoseSpec> read_pose_file(const std::filesystem::path& path);

}  // namespace hydroprint::client
