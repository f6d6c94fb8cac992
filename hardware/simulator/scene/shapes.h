#pragma once

#include "hardware/simulator/scene/scenery.h"

namespace hydroprint::simulated_scene {

/// Width of the square base and height of a marker, mm (as in the paper, section 5.2).
inline constexpr double kMarkerWidth_mm = 60;
inline constexpr double kMarkerHeight_mm = 40;

/// Returns an axis-parallel box between two corners, faces outward.
[[nodiscard]] Mesh box(const Eigen::Vector3d& least, const Eigen::Vector3d& most);

/// Returns a square pyramid on z = 0 over the origin.
[[nodiscard]] Mesh pyramid(double width_mm, double height_mm);

/// Returns a vertical cylinder around the z axis.
[[nodiscard]] Mesh rod(double radius_mm, double bottom_mm, double top_mm);

/// Returns the mesh with all points transformed.
[[nodiscard]] Mesh moved(Mesh mesh, const Pose& pose);

/// Merges meshes into one.
[[nodiscard]] Mesh joined(const std::vector<Mesh>& meshes);

/// Returns the visible mesh of a marker in frame F: the pyramid, the pyramid on its side, or a box
/// that covers it.
[[nodiscard]] Mesh marker_mesh(const Marker& marker, MarkerState state);

}  // namespace hydroprint::simulated_scene
