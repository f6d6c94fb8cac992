#include "sim/mesh/holes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/support/bodies.h"

namespace hydroprint::mesh {
namespace {

TEST(Holes, AreNamedByPlaceAndLengthLargestFirst) {
  // The walls of a cone without its two lids.
  Model model = testing::turned({{0, 0}, {5, 0}, {8, 20}, {0, 20}}, 12);
  std::erase_if(model.triangles, [&](const Eigen::Vector3i& t) {
    return model.vertices[t[0]].z() == model.vertices[t[1]].z() &&
           model.vertices[t[1]].z() == model.vertices[t[2]].z();
  });
  const Surface surface = testing::surface_of(model, 1e9);
  const auto holes = holes_of(surface.points, surface.weld, surface.triangles,
                              Edges(surface.triangles, surface.weld));
  ASSERT_EQ(holes.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(holes[i].edges, 12U);
    const double radius = i == 0 ? 8 : 5;
    EXPECT_NEAR(holes[i].length_mm, 12 * 2 * radius * std::sin(M_PI / 12), 1e-9);
    EXPECT_LT((holes[i].middle_mm - Eigen::Vector3d(0, 0, i == 0 ? 20 : 0)).norm(), 1e-9);
  }
  EXPECT_TRUE(surface.warnings.front().message.starts_with(
      "the mesh has 24 boundary edges in 2 holes (49.7 mm around ("));
}

TEST(Holes, AClosedSurfaceHasNone) {
  const Surface surface = testing::surface_of(testing::box({0, 0, 0}, {1, 1, 1}));
  EXPECT_TRUE(holes_of(surface.points, surface.weld, surface.triangles,
                       Edges(surface.triangles, surface.weld))
                  .empty());
}

}  // namespace
}  // namespace hydroprint::mesh
