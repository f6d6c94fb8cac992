#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "sim/base/pose.h"
#include "sim/base/result.h"

namespace hydroprint {

/// Content of a pose file (contract, `--pose`): X_FO at the start of the dip.
struct PoseFile {
  Eigen::Vector4d rotation_wxyz{1, 0, 0, 0};  ///< unit quaternion
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();

  [[nodiscard]] Pose pose() const;
};

/// Reads {"rotation_wxyz": [w, x, y, z], "translation_mm": [x, y, z]}; either may be left out. The
/// quaternion is normalised.
/// Refuses, naming file and key: unknown keys, lists of the wrong length, coordinates beyond 1e6
/// mm, a quaternion too short to have a direction.
[[nodiscard]] Result<PoseFile> read_pose_file(const std::filesystem::path& path);

/// Same as read_pose_file(), for JSON; `name` is its source in messages.
[[nodiscard]] Result<PoseFile> parse_pose(const nlohmann::json& json, const std::string& name);

}  // namespace hydroprint
