#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hardware/simulator/camera/lens.h"
#include "hardware/simulator/camera/sensor.h"
#include "hardware/simulator/scene/scenery.h"
#include "sim/base/context.h"
#include "sim/base/pose.h"
#include "sim/mesh/model.h"
#include "sim/mesh/surface.h"
#include "sim/registration/film_frame/markers.h"
#include "sim/scan/frame.h"
#include "sim/scan/lens.h"

/// Depth frames of known scenes, as the virtual camera draws them: what the tests of scans know the
/// truth by.
namespace hydroprint::testing {

/// To compute on.
[[nodiscard]] Context two_threads();

/// The same lens, as scans have it.
[[nodiscard]] scan::Lens lens_of(const simulated_camera::Lens& lens);

/// A rig with something in it, and the camera that looks at it. Film frame, mm.
struct Rig {
  simulated_camera::Lens lens;                       ///< the maker's
  simulated_scene::CameraStand stand;                ///< 0.8 m away
  std::vector<simulated_scene::Marker> markers;      ///< as they stand; where they should, at first
  std::vector<simulated_scene::MarkerState> states;  ///< of those
  double gripper_mm = 150;                           ///< height of its lower end
  std::vector<simulated_scene::Body> more;           ///< what else there is
  bool furnished = true;                             ///< false: only `more` is there
  simulated_camera::Errors errors;                   ///< that frames() have

  Rig();
  [[nodiscard]] Pose X_CF() const;
  /// Depths without errors but the lens's, and not hindered by shadows.
  [[nodiscard]] scan::DepthFrame exact() const;
  /// Frames of a camera with its errors, 30 a second; `seed` is the camera's, `first` the number of
  /// its first frame.
  [[nodiscard]] std::vector<scan::DepthFrame> frames(int count, std::uint64_t seed,
                                                     int first = 0) const;
};

/// The film of these rigs.
[[nodiscard]] Eigen::Vector2d film_mm();
/// Where these rigs should have their markers.
[[nodiscard]] registration::MarkerLayout nominal_layout();

/// A camera so far from the film's middle, so high over the water, turned about the vertical.
[[nodiscard]] simulated_scene::CameraStand stand_at(double distance_mm, double elevation_rad,
                                                    double azimuth_rad);

/// Part of an image; the corner on multiples of the noise's patches.
struct Window {
  int u = 0, v = 0, width_px = 0, height_px = 0;
};
[[nodiscard]] scan::DepthFrame cropped(const scan::DepthFrame& frame, const Window& window);
[[nodiscard]] scan::Lens cropped(scan::Lens lens, const Window& window);

/// A surface where a pose puts it.
[[nodiscard]] simulated_scene::Body body_of(const mesh::Surface& surface, const Pose& X_FB);

/// A model's surface, not subdivided.
[[nodiscard]] mesh::Surface surface_of(const mesh::Model& model);
[[nodiscard]] mesh::Surface box(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
/// A closed cylinder along z.
[[nodiscard]] mesh::Surface cylinder(double radius_mm, double low_mm, double high_mm, int sides);

/// A turn by such an angle about an axis drawn at random, with a shift of up to `shift_mm` each
/// way.
[[nodiscard]] Pose crooked(double angle_rad, double shift_mm, std::uint32_t seed);

}  // namespace hydroprint::testing
