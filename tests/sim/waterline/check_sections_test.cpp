#include "sim/waterline/check_sections.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/sample/icosphere.h"
#include "sim/waterline/columns.h"
#include "tests/sim/support/bodies.h"

namespace hydroprint::waterline {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// The volume along the vertical lines, mm3.
double volume_mm3(const Body& body) {
  const Columns columns(body);
  double sum = 0;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    for (const Columns::Span& span : columns.spans(c)) sum += span.to_mm - span.from_mm;
  }
  return sum * columns.cell_mm2();
}

std::vector<Waterline> lines_of(const Body& body) {
  const auto outline = film::parse_outline("A3").value();
  return take_waterlines(body, outline, body.height_mm, {}, {}, {}).value().lines;
}

TEST(Columns, FindTheVolumeOfABallBoxAndRing) {
  EXPECT_NEAR(volume_mm3(testing::body_of(testing::box({0, 0, 0}, {30, 20, 10}))) / 6000, 1, 5e-3);
  const double ball = 4.0 / 3 * std::numbers::pi * 40 * 40 * 40;
  EXPECT_NEAR(volume_mm3(testing::body_of(sample::icosphere(40, 5))) / ball, 1, 5e-3);
  const double ring = 2 * std::numbers::pi * std::numbers::pi * 30 * 8 * 8;
  EXPECT_NEAR(volume_mm3(testing::body_of(testing::torus(30, 8, 96, 48))) / ring, 1, 1e-2);
}

TEST(Columns, CountOverlapsOnceAndLeaveOutCavities) {
  const auto a = testing::box({0, 0, 0}, {20, 20, 20}), b = testing::box({10, 0, 0}, {30, 20, 20});
  EXPECT_NEAR(volume_mm3(testing::body_of(testing::together({a, b}))) / 12000, 1, 5e-3);
  const auto cavity = testing::inside_out(testing::box({5, 5, 5}, {15, 15, 15}));
  EXPECT_NEAR(volume_mm3(testing::body_of(testing::together({a, cavity}))) / 7000, 1, 5e-3);
}

TEST(Columns, FindCubesThatShareAnEdgeWhateverTheirOrientation) {
  // Edges with four faces belong to both cubes, so neighbours do not tell how to face.
  const mesh::Model cubes =
      testing::blocks({0, 10, 20}, {0, 10, 20}, {0, 10}, [](int i, int j, int) { return i == j; });
  EXPECT_NEAR(volume_mm3(testing::body_of(cubes)) / 2000, 1, 5e-3);
  Body body = testing::body_of(cubes);
  for (std::size_t t = 0; t < body.triangles.size(); t += 2) {
    std::swap(body.triangles[t][0], body.triangles[t][1]);
  }
  EXPECT_NEAR(volume_mm3(body) / 2000, 1, 5e-3);
}

TEST(CheckSections, AcceptsUnionsRingsAndCavities) {
  for (const mesh::Model& model :
       {testing::torus(30, 8, 64, 32), testing::cup(20, 25, 40, 5, false, 64),
        testing::together({testing::box({0, 0, 0}, {20, 20, 20}),
                           testing::moved(sample::icosphere(15, 3), {20, 10, 18})})}) {
    const Body body = testing::body_of(model);
    EXPECT_FALSE(check_sections(body, lines_of(body), {}));
  }
}

TEST(CheckSections, AcceptsDipsThatEndJustAfterTheContact) {
  const Body body = testing::body_of(sample::icosphere(40, 4));
  const auto outline = film::parse_outline("A4").value();
  for (const double depth_mm : {0.01, 0.1, 1.0}) {
    const auto lines = take_waterlines(body, outline, depth_mm, {}, {}, {}).value().lines;
    EXPECT_FALSE(check_sections(body, lines, {})) << depth_mm;
  }
}

TEST(CheckSections, FindsASectionThatLostAPart) {
  const Body body = testing::body_of(testing::together(
      {testing::box({-40, -5, 0}, {-20, 5, 30}), testing::box({20, -5, 0}, {40, 5, 30})}));
  std::vector<Waterline> lines = lines_of(body);
  ASSERT_FALSE(check_sections(body, lines, {}));
  for (Waterline& line : lines) {
    if (line.immersion_mm < 10 || line.immersion_mm > 20) continue;
    std::erase_if(line.section, [](const Loop& loop) { return loop.points_mm.front().x() > 0; });
  }
  const auto off = check_sections(body, lines, {});
  ASSERT_TRUE(off);
  EXPECT_NEAR(off->columns_mm3, 12000, 60);
  EXPECT_NEAR(off->sections_mm3, 10000, 400);
  EXPECT_GE(off->immersion_mm, 10);
  EXPECT_LE(off->immersion_mm, 20);
  EXPECT_NEAR(off->place_mm.x(), 30, 10);
  ASSERT_FALSE(off->triangles.empty());
  for (const int t : off->triangles) {
    EXPECT_GT(body.points_mm[body.triangles[static_cast<std::size_t>(t)][0]].x(), 0);
  }
}

TEST(CheckSections, FollowsTheMotion) {
  const Body body = testing::body_of(testing::cylinder(20, 30, 64));
  const Motion motion{{{0, 0, Vector2d::Zero()}, {6, 30, Vector2d(12, -5)}}};
  const auto outline = film::parse_outline("A4").value();
  auto lines = take_waterlines(body, outline, body.height_mm, motion, {}, {}).value().lines;
  EXPECT_FALSE(check_sections(body, lines, motion));
  for (Waterline& line : lines) {
    for (Loop& loop : line.section) {
      for (Vector2d& p : loop.points_mm) p *= 1.1;  // around the origin, not the object
    }
  }
  const auto off = check_sections(body, lines, motion);
  ASSERT_TRUE(off);
  const Vector2d axis = offset_at(motion, off->immersion_mm);
  EXPECT_NEAR((off->place_mm - axis).norm(), 21, 4);
}

}  // namespace
}  // namespace hydroprint::waterline
