#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hardware/simulator/camera/lens.h"
#include "hardware/simulator/camera/sensor.h"
#include "hardware/simulator/scene/scenery.h"
#include "sim/base/pose.h"
#include "sim/mesh/model.h"
#include "sim/mesh/surface.h"
#include "sim/registration/film_frame/markers.h"
#include "sim/scan/frame.h"
#include "sim/scan/lens.h"
#include "tests/support/two_threads.h"

/// Depth frames of known scenes, rendered by the virtual camera. They give tests of scans a known
/// ground truth.
namespace hydroprint::testing {

/// Converts a lens of the virtual camera to one for scans.
[[nodiscard]] scan::Lens lens_of(const simulated_camera::Lens& lens);

/// A rig with bodies and the camera that observes it. Film frame, mm.
struct Rig {
  simulated_camera::Lens lens;                       ///< nominal lens
  simulated_scene::CameraStand stand;                ///< stand of the camera; initially 0.8 m away
  std::vector<simulated_scene::Marker> markers;      ///< actual markers; initially nominal
  std::vector<simulated_scene::MarkerState> states;  ///< states of the markers
  double gripper_mm = 150;                           ///< height of the gripper's lower end
  std::vector<simulated_scene::Body> more;           ///< additional bodies
  bool furnished = true;            ///< false: the scene contains only the bodies `more`
  simulated_camera::Errors errors;  ///< camera errors in frames()

  Rig();
  [[nodiscard]] Pose X_CF() const;
  /// A frame without shadows and without errors, except the distortion of the lens.
  [[nodiscard]] scan::DepthFrame exact() const;
  /// Frames of a camera with errors, 30 per second; `seed` selects the camera, and `first` is the
  /// number of the first frame.
  [[nodiscard]] std::vector<scan::DepthFrame> frames(int count, std::uint64_t seed,
                                                     int first = 0) const;
};

/// Size of the film of these rigs.
[[nodiscard]] Eigen::Vector2d film_mm();
/// Nominal layout of the markers of these rigs.
[[nodiscard]] registration::MarkerLayout nominal_layout();

/// A camera at a distance, elevation and azimuth from the film's middle.
[[nodiscard]] simulated_scene::CameraStand stand_at(double distance_mm, double elevation_rad,
                                                    double azimuth_rad);

/// Part of an image. Its corner lies on a corner of a noise patch.
struct Window {
  int u = 0, v = 0, width_px = 0, height_px = 0;
};
[[nodiscard]] scan::DepthFrame cropped(const scan::DepthFrame& frame, const Window& window);
[[nodiscard]] scan::Lens cropped(scan::Lens lens, const Window& window);

/// A body with this surface, in this pose.
[[nodiscard]] simulated_scene::Body body_of(const mesh::Surface& surface, const Pose& X_FB);

/// A model's surface without subdivision.
[[nodiscard]] mesh::Surface surface_of(const mesh::Model& model);
[[nodiscard]] mesh::Surface box(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
/// A closed cylinder along z.
[[nodiscard]] mesh::Surface cylinder(double radius_mm, double low_mm, double high_mm, int sides);

/// A rotation by `angle_rad` about a random axis, with a random translation of up to `shift_mm` in
/// each direction.
[[nodiscard]] Pose crooked(double angle_rad, double shift_mm, std::uint32_t seed);

}  // namespace hydroprint::testing
