#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "sim/flow/flow_map.h"
#include "sim/sample/icosphere.h"
#include "tests/sim/support/bodies.h"
#include "tests/sim/support/dips.h"

namespace hydroprint::flow {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// An egg without relevant symmetries, off the film's centre.
mesh::Model egg() {
  mesh::Model model = sample::icosphere(1, 5);
  const Eigen::Matrix3d tilt =
      Eigen::AngleAxisd(0.5, Vector3d(1, 0.4, 0.2).normalized()).toRotationMatrix();
  for (Vector3d& v : model.vertices) {
    v = tilt * Vector3d(30 * v.x(), 22 * v.y(), 26 * v.z() * (1 + 0.1 * v.x())) +
        Vector3d(18, -12, 0);
  }
  return model;
}

std::vector<Vector2d> film_of(const mesh::Model& model, const testing::DipSetting& setting) {
  const testing::SolvedDip dip = testing::solve_dip(model, setting);
  MapOptions options;
  options.make_tiles = false;
  Context context;
  context.threads = 2;
  return make_flow_map(dip.surface, dip.body, dip.field, {}, options, context)
      .value()
      .surface.film_mm;
}

/// @param points  number of points to compare: those of the model itself
void expect_same(const std::vector<Vector2d>& got, const std::vector<Vector2d>& expected,
                 std::size_t points) {
  double square = 0, most = 0;
  int count = 0, unlike = 0;
  for (std::size_t v = 0; v < points; ++v) {
    if (std::isnan(got[v].x()) != std::isnan(expected[v].x())) ++unlike;
    const double error = (got[v] - expected[v]).norm();
    if (std::isnan(error)) continue;
    square += error * error;
    most = std::max(most, error);
    ++count;
  }
  EXPECT_GT(count, static_cast<int>(points / 2));
  EXPECT_LE(unlike, 2);
  EXPECT_LT(std::sqrt(square / count), 0.01);
  EXPECT_LT(most, 0.1);
}

TEST(FlowMap, OfTheMirroredDipIsTheMirroredMap) {
  const mesh::Model model = egg();
  mesh::Model mirrored = testing::inside_out(model);
  for (Vector3d& v : mirrored.vertices) v.x() = -v.x();
  testing::DipSetting setting;
  setting.film = testing::film_of("120x150");
  setting.depth_mm = 36;
  std::vector<Vector2d> expected = film_of(model, setting);
  for (Vector2d& p : expected) p.x() = -p.x();
  expect_same(film_of(mirrored, setting), expected, model.vertices.size());
}

TEST(FlowMap, OfTheTurnedDipIsTheTurnedMap) {
  const double angle = 0.61;
  const Eigen::Rotation2Dd turn(angle);
  const mesh::Model model = egg();
  mesh::Model turned = model;
  for (Vector3d& v : turned.vertices) v.head<2>() = turn * Vector2d(v.head<2>());
  testing::DipSetting setting;
  setting.film = testing::round_film(75, 60);
  setting.depth_mm = 36;
  std::vector<Vector2d> expected = film_of(model, setting);
  for (Vector2d& p : expected) p = turn * p;
  setting.film = testing::round_film(75, 60, angle);
  expect_same(film_of(turned, setting), expected, model.vertices.size());
}

TEST(FlowMap, AConstantOffsetOfTheMotionEqualsAMovedObject) {
  const mesh::Model model = egg();
  testing::DipSetting setting;
  setting.film = testing::film_of("120x150");
  setting.depth_mm = 20;
  const auto expected = film_of(testing::moved(model, {-7, 9, 0}), setting);
  setting.motion.rows = {{0, 0, {-7, 9}}, {10, 50, {-7, 9}}};
  const testing::SolvedDip dip = testing::solve_dip(model, setting);
  MapOptions options;
  options.make_tiles = false;
  const FlowMap map =
      make_flow_map(dip.surface, dip.body, dip.field, setting.motion, options, {}).value();
  std::size_t reached = 0;
  for (std::size_t v = 0; v < expected.size(); ++v) {
    const double error = (map.surface.film_mm[v] - expected[v]).norm();
    if (std::isnan(error)) continue;
    EXPECT_LT(error, 0.02);
    ++reached;
  }
  EXPECT_GT(reached, expected.size() / 5);
}

}  // namespace
}  // namespace hydroprint::flow
