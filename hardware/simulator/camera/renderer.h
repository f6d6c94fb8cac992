#pragma once

#include <memory>

#include "hardware/simulator/camera/lens.h"
#include "hardware/simulator/camera/sensor.h"
#include "hardware/simulator/scene/scenery.h"
#include "sim/base/result.h"

namespace hydroprint::simulated_camera {

/// Looks at a scene with one camera: rays by Embree, a lens in front, a sensor behind. What comes
/// out depends on the arguments alone. Not for several threads at a time; uses two itself.
class Renderer {
 public:
  /// Refuses (kInternal) if Embree does.
  [[nodiscard]] static Result<std::unique_ptr<Renderer>> create(
      const simulated_scene::Scenery& scenery, const Lens& lens);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Depths without errors, from a pose X_FC (simulated_scene::camera_pose). Where there is
  /// nothing, or the surface is seen at less than 10 degrees (Nguyen et al. 2012: no measurements
  /// there): 0.
  /// @param lit  only where the projector's light arrives, too
  [[nodiscard]] Depths look(const simulated_scene::Sight& sight, const Pose& X_FC, bool lit = true);

  /// A frame of the scenery's own camera, where it is at that time, with all of its errors (or
  /// none, if it has none). A sight whose camera is frozen, black or gone is taken as well.
  [[nodiscard]] Frame photograph(const simulated_scene::Sight& sight);

 private:
  struct Rays;
  explicit Renderer(std::unique_ptr<Rays> rays);
  std::unique_ptr<Rays> rays_;
};

/// The lens of a scenery's camera: the maker's, if it has no errors.
[[nodiscard]] Lens lens_of(const simulated_scene::Scenery& scenery);

}  // namespace hydroprint::simulated_camera
