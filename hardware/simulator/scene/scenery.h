#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/base/pose.h"

namespace hydroprint::simulated_scene {

/// Triangles of a surface, mm.
struct Mesh {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3i> triangles;
};

/// Something that does not change its shape: what stands in the rig (film frame F), or hangs in the
/// gripper (gripper frame G: origin where the gripper holds, z up) and moves with it.
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

/// Where the camera is and how it is held (F). It looks along its axis, the far side of the film on
/// top of its image.
struct CameraStand {
  Eigen::Vector3d at_mm{0, -350, 720};
  Eigen::Vector3d looks_at_mm{0, 0, 0};
  double turn_rad = 0;  ///< about its axis
  /// Swept by hand: from `at_mm` through these places and back, evenly in `period_s`, over and
  /// over; empty: it stands still.
  std::vector<Eigen::Vector3d> via_mm;
  double period_s = 10;
  bool trembles = true;  ///< the hand, while it sweeps
};

/// What a depth camera could see in a rig, and which camera it is.
struct Scenery {
  std::vector<Body> bodies;
  std::vector<Marker> markers;
  CameraStand stand;
  std::uint64_t seed = 1;  ///< of the camera: its lens, its noise, the hand
  bool has_errors = true;  ///< false: a perfect camera
  /// Each frame 1/30 s after the one before it, whatever the clock says: same scene, same frames.
  bool counts_frames = false;
};

enum class MarkerState { kWell, kHidden, kKnockedOver };
enum class CameraState { kWell, kGone, kFrozen, kBlack, kHung };

/// What of it changes.
struct Sight {
  double time_s = 0;
  double gripper_height_mm = 150;  ///< of the gripper's origin over the water
  CameraState camera = CameraState::kWell;
  std::vector<MarkerState> markers;  ///< as Scenery::markers; too few: the others are well
};

/// Takes gripper coordinates to F.
[[nodiscard]] Pose gripper_pose(const Sight& sight);

}  // namespace hydroprint::simulated_scene
