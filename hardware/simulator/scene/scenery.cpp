#include "hardware/simulator/scene/scenery.h"

namespace hydroprint::simulated_scene {

Pose gripper_pose(const Sight& sight) {
  Pose out = Pose::Identity();
  out.translation().z() = sight.gripper_height_mm;
  return out;
}

}  // namespace hydroprint::simulated_scene
