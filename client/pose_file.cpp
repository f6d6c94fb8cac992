#include "client/pose_file.h"

#include "sim/base/pose_file.h"

namespace hydroprint::client {

Result<v1::Pose> read_pose_file(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const PoseFile file, hydroprint::read_pose_file(path));
  v1::Pose pose;
  pose.mutable_rotation_wxyz()->Add(file.rotation_wxyz.begin(), file.rotation_wxyz.end());
  pose.mutable_translation_mm()->Add(file.translation_mm.begin(), file.translation_mm.end());
  set_uncertainty(file.uncertainty, pose);
  return pose;
}

}  // namespace hydroprint::client
