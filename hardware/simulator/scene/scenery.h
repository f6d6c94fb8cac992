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

/// A rigid body. It stands in the rig (film frame F), or hangs in the gripper and moves with it
/// (gripper frame G: origin at the gripping point, z up).
struct Body {
  std::string name;
  Mesh mesh;
  bool hangs = false;
};

/// A pyramid on a sliding bar.
struct Marker {
  std::string name;                                 ///< "left", "right", "near", "far"
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();  ///< centre of its base, in frame F
  double turn_rad = 0;                              ///< about z, counterclockwise from above
};

/// Position and orientation of the camera, in frame F. It looks along its optical axis, with the
/// far side of the film at the top of its image.
struct CameraStand {
  Eigen::Vector3d at_mm{0, -350, 720};
  Eigen::Vector3d looks_at_mm{0, 0, 0};
  double turn_rad = 0;  ///< rotation about its optical axis
  /// Path of a hand-held camera: from `at_mm` through these positions and back in `period_s`,
  /// repeatedly. Empty: the camera is stationary.
  std::vector<Eigen::Vector3d> via_mm;
  double period_s = 10;
  bool trembles = true;  ///< simulates hand tremor during a sweep
};

/// Everything that a depth camera can see in a rig, and the camera's own properties.
struct Scenery {
  std::vector<Body> bodies;
  std::vector<Marker> markers;
  CameraStand stand;
  std::uint64_t seed =
      1;  ///< for the camera: its lens, its noise (with a frame's number), the hand's motion
  bool has_errors = true;  ///< false: an ideal camera
  /// If true, frames are 1/30 s apart regardless of the clock, so the same scene yields the same
  /// frames.
  bool counts_frames = false;
};

enum class MarkerState { kWell, kHidden, kKnockedOver };
enum class CameraState { kWell, kGone, kFrozen, kBlack, kHung };

/// The variable part of a scene.
struct Sight {
  double time_s = 0;
  double gripper_height_mm = 150;  ///< height of the gripper's origin above the water
  CameraState camera = CameraState::kWell;
  std::vector<MarkerState> markers;  ///< same order as Scenery::markers; missing: kWell
};

/// Returns the pose that transforms gripper coordinates to F.
[[nodiscard]] Pose gripper_pose(const Sight& sight);

}  // namespace hydroprint::simulated_scene
