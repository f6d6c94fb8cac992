#pragma once

#include <memory>

#include "hardware/simulator/camera/lens.h"
#include "hardware/simulator/camera/sensor.h"
#include "hardware/simulator/scene/scenery.h"
#include "sim/base/result.h"

namespace hydroprint::simulated_camera {

/// Renders a scene from the view of one camera: traces rays with Embree, then applies lens and
/// sensor errors. The result depends only on the arguments. Not thread-safe; uses two threads
/// itself.
class Renderer {
 public:
  /// Returns kInternal if Embree fails.
  [[nodiscard]] static Result<std::unique_ptr<Renderer>> create(
      const simulated_scene::Scenery& scenery, const Lens& lens);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Renders depths without errors from a pose X_FC (simulated_scene::camera_pose). A depth is 0
  /// where nothing is hit, or where the angle between ray and surface is less than 10 degrees
  /// (Nguyen et al. 2012: no measurements there).
  /// @param lit  a depth is also 0 where the projector's light does not arrive
  [[nodiscard]] Depths look(const simulated_scene::Sight& sight, const Pose& X_FC, bool lit = true);

  /// Renders frame `number` of the scenery's own camera, at the camera's pose at sight.time_s, with
  /// lens and sensor errors unless Scenery::has_errors is false. Ignores sight.camera (frozen,
  /// black or gone).
  [[nodiscard]] Frame photograph(const simulated_scene::Sight& sight, int number);

 private:
  struct Rays;
  explicit Renderer(std::unique_ptr<Rays> rays);
  std::unique_ptr<Rays> rays_;
};

/// Returns the lens of a scenery's camera; the manufacturer's values if the camera has no errors.
[[nodiscard]] Lens lens_of(const simulated_scene::Scenery& scenery);

}  // namespace hydroprint::simulated_camera
