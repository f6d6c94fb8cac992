#include "client/pose_file.h"

#include "sim/base/pose_file.h"

namespace hydroprint::client {

Result<v1::Pose> read_pose_file(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const PoseFile file, hydroprint::read_pose_file(path));
  v1::Pose pose;
  set_pose(file, pose);
  return pose;
}

}  // namespace hydroprint::client
