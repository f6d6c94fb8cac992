#include "hardware/simulator/scene/shapes.h"

#include <gtest/gtest.h>

#include "hardware/simulator/scene/rig_layout.h"

namespace hydroprint::simulated_scene {
namespace {

/// The enclosed volume of a mesh, positive if its faces point outward.
double volume(const Mesh& mesh) {
  double out = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    out += mesh.points[t[0]].dot(mesh.points[t[1]].cross(mesh.points[t[2]])) / 6;
  }
  return out;
}

TEST(Shapes, HaveTheirVolumesAndFaceOutward) {
  EXPECT_NEAR(volume(box({1, 2, 3}, {4, 6, 8})), 3 * 4 * 5, 1e-9);
  EXPECT_NEAR(volume(pyramid(60, 40)), 60 * 60 * 40 / 3.0, 1e-9);
  EXPECT_NEAR(volume(rod(10, -5, 95)), M_PI * 100 * 100, 0.01 * M_PI * 1e4);
  for (const Body& body : standing_bodies({210, 297})) EXPECT_GT(volume(body.mesh), 0) << body.name;
  EXPECT_GT(volume(gripper().mesh), 0);
}

TEST(Shapes, AMarkerKnockedOverLiesOnItsSideAlongItsBar) {
  for (const Marker& marker : nominal_markers({210, 297})) {
    const Mesh lying = marker_mesh(marker, MarkerState::kKnockedOver);
    const Mesh upright = marker_mesh(marker, MarkerState::kWell);
    EXPECT_NEAR(volume(lying), volume(upright), 1e-6);
    int on_the_bar = 0;
    for (const Eigen::Vector3d& point : lying.points) {
      EXPECT_GE(point.z(), kBarTop_mm - 1e-9);
      if (point.z() < kBarTop_mm + 1e-9) ++on_the_bar;
    }
    EXPECT_EQ(on_the_bar, 3) << "a side";
  }
}

TEST(Shapes, AHiddenMarkerIsInsideItsCover) {
  for (const Marker& marker : nominal_markers({210, 297})) {
    const Mesh cover = marker_mesh(marker, MarkerState::kHidden);
    Eigen::AlignedBox3d inside;
    for (const Eigen::Vector3d& point : cover.points) inside.extend(point);
    for (const Eigen::Vector3d& point : marker_mesh(marker, MarkerState::kWell).points) {
      EXPECT_TRUE(inside.contains(point));
    }
  }
}

TEST(Shapes, NoRotationMapsMarkersOntoEachOther) {
  const auto markers = nominal_markers({210, 297});
  for (int i = 1; i < 4; ++i) {
    const Eigen::AngleAxisd turn(i * M_PI / 2, Eigen::Vector3d::UnitZ());
    double worst = 0;
    for (const Marker& marker : markers) {
      double nearest = 1e9;
      for (const Marker& other : markers) {
        nearest = std::min(nearest, (turn * marker.at_mm - other.at_mm).norm());
      }
      worst = std::max(worst, nearest);
    }
    EXPECT_GT(worst, 25) << i;
  }
}

}  // namespace
}  // namespace hydroprint::simulated_scene
