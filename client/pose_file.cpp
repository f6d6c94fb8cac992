#include "client/pose_file.h"

#include <algorithm>

#include "sim/base/pose_file.h"

namespace hydroprint::client {

Result<PoseSpec> read_pose_file(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(const PoseFile file, hydroprint::read_pose_file(path));
  PoseSpec pose;
  std::copy_n(file.rotation_wxyz.data(), pose.rotation_wxyz.size(), pose.rotation_wxyz.begin());
  std::copy_n(file.translation_mm.data(), pose.translation_mm.size(), pose.translation_mm.begin());
  return pose;
}

}  // namespace hydroprint::client
