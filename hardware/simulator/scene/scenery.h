#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/base/pose.h"

namespace hydroprint::simulated_scene {

/// A triangle mesh, mm.
struct Mesh {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;
};

/// A rigid body: it stands in the rig (film frame F), or hangs in the gripper and moves with it
/// (gripper frame G: origin where the gripper holds, z up).
struct Body {
  std::string name;
  Mesh mesh;
  bool hangs = false;
};

/// A pyramid on a sliding bar.
struct Marker {
  std::string name;                                 ///< "left", "right", "near", "far"
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();  ///< centre of its base, F
  double turn_rad = 0;                              ///< about z, seen from above
};

/// Position and orientation of the camera (F). It looks along its axis, with the far side of the
/// film at the top of its image.
struct CameraStand {
  Eigen::Vector3d at_mm{0, -350, 720};
  Eigen::Vector3d looks_at_mm{0, 0, 0};
  double turn_rad = 0;  ///< about its axis
  /// Swept by hand: from `at_mm` through these positions and back in `period_s`, repeatedly. Empty:
  /// it stands still.
  std::vector<Eigen::Vector3d> via_mm;
  double period_s = 10;
  bool trembles = true;  ///< of the hand, while it sweeps
};

/// Everything a depth camera could see in a rig, and the camera's own properties.
struct Scenery {
  std::vector<Body> bodies;
  std::vector<Marker> markers;
  CameraStand stand;
  std::uint64_t seed = 1;  ///< of the camera: its lens, its noise, the motion of the hand
  bool has_errors = true;  ///< false: a perfect camera
  /// Frames are 1/30 s apart regardless of the clock, so the same scene gives the same frames.
  bool counts_frames = false;
};

enum class MarkerState { kWell, kHidden, kKnockedOver };
enum class CameraState { kWell, kGone, kFrozen, kBlack, kHung };

/// The variable part of a scene.
struct Sight {
  double time_s = 0;
  double gripper_height_mm = 150;  ///< height of the gripper's origin above the water
  CameraState camera = CameraState::kWell;
  std::vector<MarkerState> markers;  ///< as Scenery::markers; missing entries are well
};

/// Transforms gripper coordinates to F.
[[nodiscard]] Pose gripper_pose(const Sight& sight);

}  // namespace hydroprint::simulated_scene
