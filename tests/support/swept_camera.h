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

/// A camera swept by hand over a rig, as the virtual camera draws it. Film frame, mm.
class SweptCamera {
 public:
  /// @param more       what is there beside the rig's own bodies and markers
  /// @param furnished  false: only `more` is there
  explicit SweptCamera(const std::vector<simulated_scene::Body>& more, std::uint64_t seed = 4,
                       bool has_errors = true, bool furnished = true);

  /// The camera's own.
  [[nodiscard]] scan::Lens lens() const;
  /// Where it was at a frame; 30 of them a second.
  [[nodiscard]] Pose X_FC(int frame) const;
  /// What it saw there.
  [[nodiscard]] scan::DepthFrame frame(int frame) const;
  [[nodiscard]] std::vector<scan::DepthFrame> frames(int count) const;
  /// All that is there.
  [[nodiscard]] const mesh::Surface& scene() const { return scene_; }

  /// Over and over from 0.8 m before the film to the left, above and to the right, in 10 s.
  simulated_scene::CameraStand stand;

 private:
  std::uint64_t seed_;
  bool has_errors_;
  simulated_camera::Lens lens_;
  mesh::Surface scene_;
  std::unique_ptr<simulated_camera::Renderer> renderer_;
};

/// What a camera sees that looks straight at a wall.
[[nodiscard]] scan::DepthFrame wall_frame(float depth_mm);

}  // namespace hydroprint::testing
