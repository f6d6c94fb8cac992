#pragma once

#include <memory>
#include <vector>

#include "hardware/simulator/camera/renderer.h"
#include "hardware/simulator/scene/scenery.h"
#include "sim/base/pose.h"
#include "sim/mesh/surface.h"
#include "sim/scan/frame.h"
#include "sim/scan/lens.h"

namespace hydroprint::testing {

/// A camera moved by hand over a rig, rendered by the virtual camera. Film frame, mm.
class SweptCamera {
 public:
  /// @param more       bodies in addition to the rig's own bodies and markers
  /// @param furnished  if false, there are only the bodies `more`
  explicit SweptCamera(const std::vector<simulated_scene::Body>& more, std::uint64_t seed = 4,
                       bool has_errors = true, bool furnished = true);

  /// The camera's true lens.
  [[nodiscard]] scan::Lens lens() const;
  /// Pose of the camera at a frame; there are 30 frames per second.
  [[nodiscard]] Pose X_FC(int frame) const;
  /// The depth frame at that pose.
  [[nodiscard]] scan::DepthFrame frame(int frame) const;
  [[nodiscard]] std::vector<scan::DepthFrame> frames(int count) const;
  /// The surface of the whole scene.
  [[nodiscard]] const mesh::Surface& scene() const { return scene_; }

  /// The nominal path, repeated every 10 s: from a place 0.8 m in front of the film to its left,
  /// above it and to its right.
  simulated_scene::CameraStand stand;

 private:
  std::uint64_t seed_;
  bool has_errors_;
  simulated_camera::Lens lens_;
  mesh::Surface scene_;
  std::unique_ptr<simulated_camera::Renderer> renderer_;
};

/// The depth frame of a camera that faces a wall at this depth.
[[nodiscard]] scan::DepthFrame wall_frame(float depth_mm);

}  // namespace hydroprint::testing
