#include "hardware/simulator/scene/shapes.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace hydroprint::simulated_scene {
namespace {

constexpr int kRodSides = 32;
constexpr double kCoverWidth_mm = 76;
constexpr double kCoverHeight_mm = 52;

/// Returns the pose of a marker that is tipped over its edge at x = width / 2 until its side face
/// there lies on the ground.
Pose tipped_over() {
  constexpr double kHalf_mm = kMarkerWidth_mm / 2;
  const double slope = std::atan2(kMarkerHeight_mm, kHalf_mm);
  const Eigen::Translation3d to_edge(kHalf_mm, 0, 0);
  return to_edge * Eigen::AngleAxisd(std::numbers::pi - slope, Eigen::Vector3d::UnitY()) *
         to_edge.inverse();
}

Pose standing(const Marker& marker) {
  return Eigen::Translation3d(marker.at_mm) *
         Eigen::AngleAxisd(marker.turn_rad, Eigen::Vector3d::UnitZ());
}

Mesh cover() {
  constexpr double kHalf_mm = kCoverWidth_mm / 2;
  return box({-kHalf_mm, -kHalf_mm, 0}, {kHalf_mm, kHalf_mm, kCoverHeight_mm});
}

}  // namespace

Mesh box(const Eigen::Vector3d& least, const Eigen::Vector3d& most) {
  Mesh out;
  for (int corner = 0; corner < 8; ++corner) {
    out.points.emplace_back((corner & 1) != 0 ? most.x() : least.x(),
                            (corner & 2) != 0 ? most.y() : least.y(),
                            (corner & 4) != 0 ? most.z() : least.z());
  }
  out.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return out;
}

Mesh pyramid(double width_mm, double height_mm) {
  const double half = width_mm / 2;
  return {
      {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}, {0, 0, height_mm}},
      {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};
}

Mesh rod(double radius_mm, double bottom_mm, double top_mm) {
  Mesh out;
  out.points = {{0, 0, bottom_mm}, {0, 0, top_mm}};
  for (int i = 0; i < kRodSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kRodSides;
    for (const double z : {bottom_mm, top_mm}) {
      out.points.emplace_back(radius_mm * std::cos(angle), radius_mm * std::sin(angle), z);
    }
  }
  for (int i = 0; i < kRodSides; ++i) {
    const int low = 2 + 2 * i;
    const int next = 2 + 2 * ((i + 1) % kRodSides);
    out.triangles.insert(
        out.triangles.end(),
        {{low, next, low + 1}, {next, next + 1, low + 1}, {0, next, low}, {1, low + 1, next + 1}});
  }
  return out;
}

Mesh moved(Mesh mesh, const Pose& pose) {
  for (Eigen::Vector3d& point : mesh.points) point = pose * point;
  return mesh;
}

Mesh joined(const std::vector<Mesh>& meshes) {
  Mesh out;
  for (const Mesh& mesh : meshes) {
    const Eigen::Vector3i first = Eigen::Vector3i::Constant(static_cast<int>(out.points.size()));
    out.points.insert(out.points.end(), mesh.points.begin(), mesh.points.end());
    for (const Eigen::Vector3i& triangle : mesh.triangles)
      out.triangles.emplace_back(triangle + first);
  }
  return out;
}

Mesh marker_mesh(const Marker& marker, MarkerState state) {
  const Mesh upright = pyramid(kMarkerWidth_mm, kMarkerHeight_mm);
  switch (state) {
    case MarkerState::kHidden:
      return moved(cover(), standing(marker));
    case MarkerState::kKnockedOver:
      return moved(upright, standing(marker) * tipped_over());
    case MarkerState::kWell:
      break;
  }
  return moved(upright, standing(marker));
}

}  // namespace hydroprint::simulated_scene
