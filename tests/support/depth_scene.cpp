#include "tests/support/depth_scene.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <random>
#include <utility>

#include "hardware/simulator/camera/renderer.h"
#include "hardware/simulator/camera/sensor.h"
#include "hardware/simulator/scene/hand.h"
#include "hardware/simulator/scene/rig_layout.h"
#include "hardware/simulator/scene/shapes.h"
#include "sim/mesh/make_surface.h"

namespace hydroprint::testing {
namespace {

using std::numbers::pi;

simulated_camera::Depths look(const Rig& rig, bool lit) {
  simulated_scene::Scenery scenery;
  scenery.bodies = rig.more;
  if (rig.furnished) {
    for (auto& body : simulated_scene::standing_bodies(film_mm()))
      scenery.bodies.push_back(std::move(body));
    scenery.bodies.push_back(simulated_scene::gripper());
    scenery.markers = rig.markers;
  }
  simulated_scene::Sight sight;
  sight.gripper_height_mm = rig.gripper_mm;
  sight.markers = rig.states;
  const auto renderer = simulated_camera::Renderer::create(scenery, rig.lens);
  if (!renderer) {
    std::fprintf(stderr, "%s\n", renderer.error().message.c_str());
    std::abort();
  }
  return (*renderer)->look(sight, rig.X_CF().inverse(), lit);
}

mesh::Model model_of(const simulated_scene::Mesh& mesh) {
  mesh::Model model;
  model.path = "test";
  model.vertices = mesh.points;
  model.triangles = mesh.triangles;
  return model;
}

}  // namespace

scan::Lens lens_of(const simulated_camera::Lens& lens) {
  scan::Lens out;
  out.fx_px = out.fy_px = lens.focal_px;
  out.cx_px = lens.centre_px.x();
  out.cy_px = lens.centre_px.y();
  out.k1 = lens.k1;
  out.k2 = lens.k2;
  out.p1 = lens.p1;
  out.p2 = lens.p2;
  out.depth_scale = 1 / lens.depth_scale;
  return out;
}

Eigen::Vector2d film_mm() { return {210, 297}; }

Rig::Rig()
    : markers(simulated_scene::nominal_markers(film_mm())),
      states(markers.size(), simulated_scene::MarkerState::kWell) {}

Pose Rig::X_CF() const { return simulated_scene::camera_pose(stand, 0, 0).inverse(); }

scan::DepthFrame Rig::exact() const {
  scan::DepthFrame out{simulated_camera::kWidth_px, simulated_camera::kHeight_px,
                       look(*this, false)};
  for (float& depth : out.depth_mm) depth *= static_cast<float>(lens.depth_scale);
  return out;
}

std::vector<scan::DepthFrame> Rig::frames(int count, std::uint64_t seed, int first) const {
  const simulated_camera::Depths depths = look(*this, true);
  std::vector<scan::DepthFrame> out;
  for (int i = 0; i < count; ++i) {
    const auto frame = simulated_camera::sense(depths, lens.depth_scale, errors, seed, first + i);
    out.push_back({simulated_camera::kWidth_px, simulated_camera::kHeight_px,
                   std::vector<float>(frame.begin(), frame.end())});
  }
  return out;
}

registration::MarkerLayout nominal_layout() {
  registration::MarkerLayout out;
  out.width_mm = simulated_scene::kMarkerWidth_mm;
  out.height_mm = simulated_scene::kMarkerHeight_mm;
  for (const auto& marker : simulated_scene::nominal_markers(film_mm())) {
    Pose X_FM = Pose::Identity();
    X_FM.translate(marker.at_mm);
    X_FM.rotate(Eigen::AngleAxisd(marker.turn_rad, Eigen::Vector3d::UnitZ()));
    out.markers.push_back({marker.name, X_FM});
  }
  return out;
}

simulated_scene::CameraStand stand_at(double distance_mm, double elevation_rad,
                                      double azimuth_rad) {
  simulated_scene::CameraStand out;
  out.at_mm = distance_mm * Eigen::Vector3d(std::sin(azimuth_rad) * std::cos(elevation_rad),
                                            -std::cos(azimuth_rad) * std::cos(elevation_rad),
                                            std::sin(elevation_rad));
  return out;
}

scan::DepthFrame cropped(const scan::DepthFrame& frame, const Window& window) {
  scan::DepthFrame out{window.width_px, window.height_px, {}};
  for (int v = 0; v < window.height_px; ++v)
    for (int u = 0; u < window.width_px; ++u)
      out.depth_mm.push_back(frame.depth_mm[frame.index(window.u + u, window.v + v)]);
  return out;
}

scan::Lens cropped(scan::Lens lens, const Window& window) {
  lens.width_px = window.width_px;
  lens.height_px = window.height_px;
  lens.cx_px -= window.u;
  lens.cy_px -= window.v;
  return lens;
}

simulated_scene::Body body_of(const mesh::Surface& surface, const Pose& X_FB) {
  return {"body", simulated_scene::moved({surface.points, surface.triangles}, X_FB), false};
}

mesh::Surface surface_of(const mesh::Model& model) {
  auto surface = mesh::make_surface(model, 1e6, {});
  if (!surface) std::abort();
  return std::move(*surface);
}

mesh::Surface box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return surface_of(model_of(simulated_scene::box(low, high)));
}

mesh::Surface cylinder(double radius_mm, double low_mm, double high_mm, int sides) {
  simulated_scene::Mesh mesh{{{0, 0, low_mm}, {0, 0, high_mm}}, {}};
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * pi * i / sides;
    const double x = radius_mm * std::cos(angle), y = radius_mm * std::sin(angle);
    mesh.points.emplace_back(x, y, low_mm);
    mesh.points.emplace_back(x, y, high_mm);
    const int a = 2 + 2 * i, b = 2 + 2 * ((i + 1) % sides);
    mesh.triangles.insert(mesh.triangles.end(),
                          {{0, b, a}, {1, a + 1, b + 1}, {a, b, b + 1}, {a, b + 1, a + 1}});
  }
  return surface_of(model_of(mesh));
}

Pose crooked(double angle_rad, double shift_mm, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> even(-1, 1);
  std::normal_distribution<double> normal;
  const Eigen::Vector3d axis(normal(random), normal(random), normal(random));
  Pose out = Pose::Identity();
  out.linear() = Eigen::AngleAxisd(angle_rad, axis.normalized()).matrix();
  out.translation() = shift_mm * Eigen::Vector3d(even(random), even(random), even(random));
  return out;
}

}  // namespace hydroprint::testing
