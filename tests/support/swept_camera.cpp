#include "tests/support/swept_camera.h"

#include <cstdio>
#include <cstdlib>

#include "hardware/simulator/camera/sensor.h"
#include "hardware/simulator/scene/hand.h"
#include "hardware/simulator/scene/rig_layout.h"
#include "hardware/simulator/scene/shapes.h"
#include "tests/support/depth_scene.h"

namespace hydroprint::testing {
namespace {

constexpr double kGripper_mm = 200;

simulated_scene::Scenery scenery_of(const std::vector<simulated_scene::Body>& more,
                                    bool furnished) {
  simulated_scene::Scenery out;
  out.bodies = more;
  if (!furnished) return out;
  for (auto& body : simulated_scene::standing_bodies(film_mm()))
    out.bodies.push_back(std::move(body));
  out.bodies.push_back(simulated_scene::gripper());
  out.markers = simulated_scene::nominal_markers(film_mm());
  return out;
}

mesh::Surface scene_of(const simulated_scene::Scenery& scenery,
                       const simulated_scene::Sight& sight) {
  std::vector<simulated_scene::Mesh> all;
  for (const auto& body : scenery.bodies)
    all.push_back(body.hangs
                      ? simulated_scene::moved(body.mesh, simulated_scene::gripper_pose(sight))
                      : body.mesh);
  for (const auto& marker : scenery.markers)
    all.push_back(simulated_scene::marker_mesh(marker, simulated_scene::MarkerState::kWell));
  mesh::Model model;
  const simulated_scene::Mesh mesh = simulated_scene::joined(all);
  model.path = "scene";
  model.vertices = mesh.points;
  model.triangles = mesh.triangles;
  return surface_of(model);
}

simulated_scene::Sight sight_at(int frame) {
  simulated_scene::Sight out;
  out.time_s = static_cast<double>(frame) / simulated_camera::kRate_hz;
  out.gripper_height_mm = kGripper_mm;
  return out;
}

}  // namespace

SweptCamera::SweptCamera(const std::vector<simulated_scene::Body>& more, std::uint64_t seed,
                         bool has_errors, bool furnished)
    : seed_(seed), has_errors_(has_errors) {
  stand.via_mm = {{-300, -250, 700}, {0, -150, 800}, {300, -250, 700}};
  const simulated_scene::Scenery scenery = scenery_of(more, furnished);
  if (has_errors) lens_ = simulated_camera::drawn_lens(seed);
  scene_ = scene_of(scenery, sight_at(0));
  auto renderer = simulated_camera::Renderer::create(scenery, lens_);
  if (!renderer) {
    std::fprintf(stderr, "%s\n", renderer.error().message.c_str());
    std::abort();
  }
  renderer_ = std::move(*renderer);
}

scan::Lens SweptCamera::lens() const { return lens_of(lens_); }

Pose SweptCamera::X_FC(int frame) const {
  return simulated_scene::camera_pose(stand, seed_, sight_at(frame).time_s);
}

scan::DepthFrame SweptCamera::frame(int frame) const {
  const auto depths = renderer_->look(sight_at(frame), X_FC(frame), has_errors_);
  scan::DepthFrame out{simulated_camera::kWidth_px, simulated_camera::kHeight_px, depths};
  if (!has_errors_) return out;
  const auto told = simulated_camera::sense(depths, lens_.depth_scale, {}, seed_, frame);
  out.depth_mm.assign(told.begin(), told.end());
  return out;
}

std::vector<scan::DepthFrame> SweptCamera::frames(int count) const {
  std::vector<scan::DepthFrame> out;
  for (int i = 0; i < count; ++i) out.push_back(frame(i));
  return out;
}

scan::DepthFrame wall_frame(float depth_mm) {
  constexpr std::size_t kPixels = simulated_camera::kWidth_px * simulated_camera::kHeight_px;
  return {simulated_camera::kWidth_px, simulated_camera::kHeight_px,
          std::vector<float>(kPixels, depth_mm)};
}

}  // namespace hydroprint::testing
