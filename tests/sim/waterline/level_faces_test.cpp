#include "sim/waterline/level_faces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "sim/sample/icosphere.h"
#include "tests/sim/support/bodies.h"

namespace hydroprint::waterline {
namespace {

std::vector<LevelFace> found(const mesh::Model& model, double max_edge_mm = 2) {
  const Body body = testing::body_of(model, max_edge_mm);
  return find_level_faces(body, std::vector<char>(body.triangles.size(), 1));
}

TEST(LevelFaces, AreThoseThatFaceDown) {
  for (const double max_edge_mm : {1.5, 100.0}) {
    const auto faces = found(testing::box({-15, -10, 0}, {15, 10, 20}), max_edge_mm);
    ASSERT_EQ(faces.size(), 1U);
    EXPECT_NEAR(faces[0].area_mm2, 600, 1e-6);
    EXPECT_NEAR(faces[0].immersion_mm, 0, 1e-9);
    EXPECT_LT(faces[0].place_mm.norm(), 7) << "near the middle";
  }
}

TEST(LevelFaces, AreLevelToATenthOfADegree) {
  const mesh::Model box = testing::box({-15, -10, 0}, {15, 10, 20});
  EXPECT_EQ(found(testing::tilted(box, 1.9e-3)).size(), 1U);
  EXPECT_TRUE(found(testing::tilted(box, 2.1e-3)).empty());
  EXPECT_TRUE(found(testing::tilted(box, 20 * std::numbers::pi / 180)).empty());
}

TEST(LevelFaces, AreWiderThanTwoCapillaryLengths) {
  const double width_mm = 2 * kCapillaryLength_mm;
  const auto annulus = [&](double factor) {  // the mean width of an annulus is its width
    const double outer_mm = 20 + factor * width_mm;
    return testing::turned({{20, 20}, {20, 0}, {outer_mm, 0}, {outer_mm, 20}}, 96);
  };
  EXPECT_TRUE(found(annulus(0.98)).empty());
  const auto faces = found(annulus(1.02));
  ASSERT_EQ(faces.size(), 1U);
  const double radius_mm = faces[0].place_mm.norm();
  EXPECT_GT(radius_mm, 20) << "the place lies on the face, not in its hole";
  EXPECT_LT(radius_mm, 20 + 1.02 * width_mm);
  // The mean width of a disc is its radius.
  EXPECT_TRUE(found(testing::cylinder(0.98 * width_mm, 20, 64)).empty());
  EXPECT_EQ(found(testing::cylinder(1.02 * width_mm, 20, 64)).size(), 1U);
}

TEST(LevelFaces, AreNotThePolesOfSpheres) {
  for (const int subdivisions : {1, 2, 3, 5}) {
    EXPECT_TRUE(found(sample::icosphere(30, subdivisions)).empty()) << subdivisions;
  }
}

TEST(LevelFaces, AreListedByAreaAndSeparately) {
  // A table with one leg as wide as a hand: the underside of its top, and the foot.
  const auto faces =
      found(testing::blocks({-20, -8, 8, 20}, {-20, -8, 8, 20}, {0, 16, 20},
                            [](int i, int j, int k) { return k == 1 || (i == 1 && j == 1); }));
  ASSERT_EQ(faces.size(), 2U);
  EXPECT_NEAR(faces[0].area_mm2, 40 * 40 - 16 * 16, 1e-6);
  EXPECT_NEAR(faces[0].immersion_mm, 16, 1e-9);
  EXPECT_NEAR(faces[1].area_mm2, 16 * 16, 1e-6);
  EXPECT_NEAR(faces[1].immersion_mm, 0, 1e-9);
}

TEST(LevelFaces, ConsistOfCountedTriangles) {
  const Body body = testing::body_of(testing::box({-15, -10, 0}, {15, 10, 20}));
  std::vector<char> counted(body.triangles.size(), 1);
  for (std::size_t t = 0; t < counted.size(); ++t) {
    for (const int v : body.triangles[t]) counted[t] &= body.points_mm[v].x() < 1e-9;
  }
  const auto faces = find_level_faces(body, counted);
  ASSERT_EQ(faces.size(), 1U);
  EXPECT_LT(faces[0].area_mm2, 301);
  EXPECT_GT(faces[0].area_mm2, 200);
  EXPECT_TRUE(find_level_faces(body, std::vector<char>(counted.size(), 0)).empty());
}

}  // namespace
}  // namespace hydroprint::waterline
