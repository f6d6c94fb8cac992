#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "sim/base/pose_file.h"

namespace hydroprint {

/// Largest number of dips that share one picture.
inline constexpr int kMostDips = 12;

/// One dip of an immersions file (option `--immersions`).
struct ListedDip {
  PoseFile pose;
  std::optional<double> depth_mm;  ///< nullopt: the whole object is dipped
};

/// Reads a list of 1 to kMostDips dips: [{"rotation_wxyz": [w, x, y, z], "translation_mm": [x, y,
/// z], "depth_mm": D or "full"}, ...]. Rotation and translation are required and may be accompanied
/// by the other keys of a pose file. Without a depth the whole object is dipped.
/// Returns an error with file, dip and key: those of read_pose_file(), quaternions that are not of
/// length one, depths that are not positive, and lists of the wrong length.
[[nodiscard]] Result<std::vector<ListedDip>> read_immersions_file(
    const std::filesystem::path& path);

/// Same as read_immersions_file(), for JSON; `name` identifies the source in messages.
[[nodiscard]] Result<std::vector<ListedDip>> parse_immersions(const nlohmann::json& json,
                                                              const std::string& name);

/// Sets the fields of a DipSetup message, which has none of them yet.
template <class Message>
void set_dip(const ListedDip& dip, Message& message) {
  set_pose(dip.pose, *message.mutable_pose());
  if (dip.depth_mm) message.set_depth_mm(*dip.depth_mm);
}

}  // namespace hydroprint
