#include "sim/image/layers/placement.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/sim/image/layers/layer_scenes.h"

namespace hydroprint::image {
namespace {

using namespace testing;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

Placement placed(const Layer& layer, Projection projection, double aspect = 1,
                 const Eigen::Matrix3d& R_FO = Eigen::Matrix3d::Identity(),
                 const Vector3d& size = {40, 20, 60}) {
  mesh::Model model = box_model(size, 1);
  for (Vector3d& p : model.vertices) p += Vector3d(100, 200, 300);
  auto out = place(layer, projection, model, R_FO, aspect);
  EXPECT_TRUE(out) << (out ? "" : out.error().message);
  return *out;
}

/// A point relative to the middle of the box.
Vector3d at(double x, double y, double z) { return Vector3d(100 + x, 200 + y, 300 + z); }

void expect_uv(const Vector2d& uv, double u, double v) {
  EXPECT_NEAR(uv.x(), u, 1e-9);
  EXPECT_NEAR(uv.y(), v, 1e-9);
}

TEST(Placement, APictureIsSeenFromBelowAndFittedToTheLargerSide) {
  for (const Projection projection : {Projection::kPlanar, Projection::kDip}) {
    const Placement wide = placed({}, projection, 2);
    EXPECT_NEAR(wide.height_mm, 40, 1e-9);
    EXPECT_NEAR(wide.width_mm, 80, 1e-9);
    const Placement tall = placed({}, projection, 0.5);
    EXPECT_NEAR(tall.width_mm, 40, 1e-9);
    // Who looks up from below, with y upwards, has x on the left.
    expect_uv(wide.plane().uv(at(0, 0, -30)), 0.5, 0.5);
    expect_uv(wide.plane().uv(at(-20, 0, 7)), 0.75, 0.5);
    expect_uv(wide.plane().uv(at(0, 10, 7)), 0.5, 0.75);
  }
  EXPECT_NEAR(placed({}, Projection::kDecal, 2).width_mm, 40, 1e-9) << "a decal shows as a whole";
  EXPECT_NEAR(placed({}, Projection::kDecal, 0.5).width_mm, 20, 1e-9);
}

TEST(Placement, TheDipIsAlongZOfTheFilmAndPlanarAlongADirectionOfTheObject) {
  // The object is turned over about x: the film sees what is on top in the file.
  const Eigen::Matrix3d over = Eigen::AngleAxisd(kPi, Vector3d::UnitX()).toRotationMatrix();
  Layer layer;
  layer.size_mm = 40;
  const Placement dip = placed(layer, Projection::kDip, 1, over);
  EXPECT_LT((dip.axes.col(2) - Vector3d(0, 0, -1)).norm(), 1e-12);
  expect_uv(dip.plane().uv(at(-10, -10, 0)), 0.75, 0.75);
  layer.direction = Vector3d(0, 3, 0);
  const Placement front = placed(layer, Projection::kPlanar, 1, over);
  expect_uv(front.plane().uv(at(10, -10, 20)), 0.75, 1.0);
}

TEST(Placement, AMirroredPictureIsTurnedCounterClockwise) {
  Layer layer;
  layer.direction = Vector3d(0, 1, 0);
  layer.size_mm = 40;
  layer.turn_rad = kPi / 2;
  // The picture's right is now up.
  expect_uv(placed(layer, Projection::kPlanar).plane().uv(at(0, 0, 10)), 0.75, 0.5);
  layer.mirror = true;
  expect_uv(placed(layer, Projection::kPlanar).plane().uv(at(0, 0, 10)), 0.25, 0.5);
}

TEST(Placement, TheMiddleIsAtThePosition) {
  Layer layer;
  layer.direction = Vector3d(0, 1, 0);
  layer.position_mm = at(3, 9, -4);
  layer.size_mm = 10;
  expect_uv(placed(layer, Projection::kPlanar).plane().uv(at(5.5, -10, -4)), 0.75, 0.5);
}

TEST(Placement, ACylinderRepeatsAWholeNumberOfTimes) {
  const double around_mm = kPi * 40;  // R is half of the larger horizontal side
  Layer layer;
  const Placement once = placed(layer, Projection::kCylindrical, 2);
  EXPECT_NEAR(once.width_mm, around_mm, 1e-9);
  EXPECT_NEAR(once.height_mm, around_mm / 2, 1e-9);
  const auto uv = [](const Placement& p, const Vector3d& q) { return p.around(p.angle_rad(q), q); };
  expect_uv(uv(once, at(0, -10, 0)), 0.5, 0.5);
  expect_uv(uv(once, at(20, 0, around_mm / 8)), 0.75, 0.75);
  layer.size_mm = around_mm / 2.8;
  EXPECT_NEAR(placed(layer, Projection::kCylindrical, 2).width_mm, around_mm / 3, 1e-9);
  layer.size_mm = 10 * around_mm;
  EXPECT_NEAR(placed(layer, Projection::kCylindrical, 2).width_mm, around_mm, 1e-9);
  layer.repeat = false;
  EXPECT_NEAR(placed(layer, Projection::kCylindrical, 2).width_mm, 10 * around_mm, 1e-9);
  layer.turn_rad = kPi / 2;
  expect_uv(uv(placed(layer, Projection::kCylindrical, 2), at(20, 0, 0)), 0.5, 0.5);
}

TEST(Placement, ABoxHasAPlanePerAxis) {
  Layer layer;
  layer.size_mm = 60;
  const Placement box = placed(layer, Projection::kBox);
  EXPECT_NEAR(box.blend_mm, 6, 1e-9);
  // Seen from the front, from the right-hand side, and from above.
  expect_uv(box.plane(2).uv(at(15, -10, 15)), 0.75, 0.75);
  expect_uv(box.plane(0).uv(at(20, 6, 15)), 0.6, 0.75);
  expect_uv(box.plane(1).uv(at(15, 6, 30)), 0.75, 0.6);
}

TEST(Placement, DirectionsThatDetermineNothingAreRefusedWithTheLayersName) {
  const mesh::Model model = box_model({10, 10, 10}, 1);
  const auto refused = [&](const Vector3d& direction, const Vector3d& up) {
    Layer layer;
    layer.name = "\"eyes\"";
    layer.direction = direction;
    layer.up = up;
    const auto out = place(layer, Projection::kPlanar, model, Eigen::Matrix3d::Identity(), 1);
    EXPECT_FALSE(out);
    return out ? std::string() : out.error().message;
  };
  EXPECT_NE(refused({0, 0, 0}, {0, 0, 1}).find("\"eyes\""), std::string::npos);
  EXPECT_NE(refused({0, 1, 0}, {0, 0, 0}).find("up"), std::string::npos);
  EXPECT_NE(refused({0, 0, 1}, {0.001, 0, -1}).find("parallel"), std::string::npos);
}

}  // namespace
}  // namespace hydroprint::image
