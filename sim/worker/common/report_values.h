#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "sim/base/pose.h"
#include "sim/base/result.h"
#include "sim/film/outline.h"
#include "sim/worker/common/report.h"

namespace hydroprint::v1 {
class ReportWarning;
}  // namespace hydroprint::v1

// Values that the reports of several verbs contain. For inclusion in .cpp files only.
namespace hydroprint::worker {

/// Returns [x, y].
[[nodiscard]] Json pair_of(const Eigen::Vector2d& v);
/// Returns [x, y, z].
[[nodiscard]] Json list_of(const Eigen::Vector3d& v);

/// Returns a pose in the format of pose files (option `--pose`).
[[nodiscard]] Json pose_json(const Pose& X_FO);

[[nodiscard]] Json film_json(const film::Outline& outline);

/// Returns [{code, message, where}].
[[nodiscard]] Json warnings_json(const Warnings& warnings);

/// Sets a warning of a report that is declared as a message.
void set_warning(const Warning& warning, v1::ReportWarning& out);

/// Returns the text as UTF-8, which JSON and messages need; file names may contain other bytes.
[[nodiscard]] std::string utf8(const std::string& text);

struct MeshSize {
  std::size_t vertices = 0, triangles = 0;
};
[[nodiscard]] Json mesh_json(const MeshSize& size);

}  // namespace hydroprint::worker
