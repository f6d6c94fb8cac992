#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "sim/base/pose.h"
#include "sim/base/pose_uncertainty.h"
#include "sim/base/result.h"

namespace hydroprint {

/// Content of a pose file (option `--pose`): X_FO at the start of the dip.
struct PoseFile {
  Eigen::Vector4d rotation_wxyz{1, 0, 0, 0};  ///< unit quaternion
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();
  PoseUncertainty uncertainty;

  [[nodiscard]] Pose pose() const;
};

/// Returns whether a quaternion has length one, to 0.001.
[[nodiscard]] bool is_unit(const Eigen::Vector4d& rotation_wxyz);
/// Returns what is wrong with a quaternion that is_unit() refuses, with the remedy.
[[nodiscard]] std::string not_unit_problem(const Eigen::Vector4d& rotation_wxyz);

/// Sets the fields of a pose message, which has none of them yet.
template <class Message>
void set_pose(const PoseFile& file, Message& pose) {
  pose.mutable_rotation_wxyz()->Add(file.rotation_wxyz.begin(), file.rotation_wxyz.end());
  pose.mutable_translation_mm()->Add(file.translation_mm.begin(), file.translation_mm.end());
  set_uncertainty(file.uncertainty, pose);
}

/// Reads {"rotation_wxyz": [w, x, y, z], "translation_mm": [x, y, z]}, and the "error_p95_mm" and
/// "from_nominal_pose" of a calibration; all keys are optional. The quaternion is normalised.
/// Returns an error with file and key for unknown keys, lists of the wrong length, coordinates
/// beyond 1e6 mm, quaternions of almost zero length, negative errors, and motions that are not
/// texts.
[[nodiscard]] Result<PoseFile> read_pose_file(const std::filesystem::path& path);

/// Same as read_pose_file(), for JSON; `name` identifies the source in messages.
[[nodiscard]] Result<PoseFile> parse_pose(const nlohmann::json& json, const std::string& name);

}  // namespace hydroprint
