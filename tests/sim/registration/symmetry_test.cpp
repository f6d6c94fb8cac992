// Turns that carry a mesh onto itself.
#include "sim/registration/symmetry.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>

#include "sim/mesh/read/read_model.h"
#include "sim/sample/icosphere.h"
#include "tests/sim/registration/limits.h"
#include "tests/support/depth_scene.h"
#include "tests/support/paths.h"

namespace hydroprint::registration {
namespace {

using testing::box;
using testing::cylinder;

/// Any rotation and shift of the mesh in its frame.
const Pose kAskew = Eigen::Translation3d(30, -12, 7) *
                    Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized());

std::vector<Eigen::Vector3d> axes_of(const mesh::Surface& surface) {
  return symmetry_axes(Shape(moved(surface, kAskew)));
}

mesh::Surface with_knob(const mesh::Surface& body, const Eigen::Vector3d& at, double size_mm) {
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(size_mm / 2);
  return joined(body, box(at - half, at + half));
}

TEST(Symmetry, ASphereHasThreeAxes) {
  EXPECT_EQ(axes_of(testing::surface_of(sample::icosphere(40, 4))).size(), 3U);
}

TEST(Symmetry, ACylinderAndATubeHaveTheirAxis) {
  for (const int sides : {32, 180}) {
    for (const mesh::Surface& body :
         {cylinder(40, 0, 90, sides),
          joined(cylinder(40, 0, 20, sides), cylinder(25, 20, 90, sides))}) {
      const auto axes = axes_of(body);
      ASSERT_EQ(axes.size(), 1U) << sides;
      const double off = std::abs(axes[0].dot(kAskew.linear().col(2)));
      EXPECT_LT(std::acos(std::min(1.0, off)), 0.1 * kDegree) << sides;
    }
  }
}

/// Their turns by 90 or 30 degrees are few, and the one nearest to the nominal pose is found.
TEST(Symmetry, CubesAndPolygonsWithFewCornersHaveNoAxis) {
  EXPECT_TRUE(axes_of(box({-20, -20, -20}, {20, 20, 20})).empty());
  EXPECT_TRUE(axes_of(box({-60, -60, 0}, {60, 60, 10})).empty());
  EXPECT_TRUE(axes_of(cylinder(40, 0, 90, 12)).empty());
}

TEST(Symmetry, AHandleOrAKnobDeterminesTheTurn) {
  EXPECT_TRUE(axes_of(with_knob(cylinder(40, 0, 90, 180), {44, 0, 45}, 10)).empty());
  EXPECT_TRUE(
      axes_of(with_knob(testing::surface_of(sample::icosphere(40, 4)), {0, 0, 41}, 6)).size() < 3);
}

TEST(Symmetry, AMugAScanAndASculptureHaveNoAxis) {
  for (const char* name : {"mug/mug.obj", "spot/spot_triangulated.obj", "bunny/bunny_hr.obj"}) {
    const std::filesystem::path path = testing::model_path(name);
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
    const auto model = mesh::read_model(path, 1, {});
    ASSERT_TRUE(model) << model.error().message;
    EXPECT_TRUE(axes_of(testing::surface_of(*model)).empty()) << name;
  }
}

}  // namespace
}  // namespace hydroprint::registration
