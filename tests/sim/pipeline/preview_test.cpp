#include "sim/pipeline/preview.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/sample/icosphere.h"
#include "tests/sim/pipeline/dips.h"
#include "tests/sim/support/bodies.h"

namespace hydroprint::pipeline {
namespace {

using testing::dipped;
using testing::options_for;
namespace bodies = hydroprint::testing;

TEST(Preview, ShowsLandingPointsToAboutAMillimetre) {
  for (const double radius_mm : {60.0, 20.0}) {
    const mesh::Model sphere = sample::icosphere(radius_mm, 5);
    DipOptions options = options_for("A4", FilmModel::kStokes);
    options.depth_mm = radius_mm * 1.5;  // theta = 120 degrees
    options.X_FO = Pose(Eigen::Translation3d(10, -20, 0));
    const Dip exact = dipped(sphere, options);
    const Dip rough = dipped(sphere, preview_of(options));
    double square = 0, most = 0;
    int count = 0;
    for (std::size_t v = 0; v < sphere.vertices.size(); ++v) {
      if (!exact.map.surface.film_mm[v].allFinite()) continue;
      const double apart = (exact.map.surface.film_mm[v] - rough.map.surface.film_mm[v]).norm();
      ASSERT_TRUE(std::isfinite(apart)) << sphere.vertices[v].transpose();
      square += apart * apart;
      most = std::max(most, apart);
      ++count;
    }
    EXPECT_GT(count, 7000);
    EXPECT_LT(std::sqrt(square / count), 0.3) << radius_mm;
    EXPECT_LT(most, 1.0) << radius_mm;
  }
}

TEST(Preview, UsesTheModelsOwnTriangles) {
  const mesh::Model box = bodies::box({-15, -10, 0}, {15, 10, 20});
  const Dip rough = dipped(box, preview_of(options_for("100x90")));
  EXPECT_EQ(rough.surface.triangles.size(), box.triangles.size());
  EXPECT_TRUE(rough.map.tiles.empty());
}

}  // namespace
}  // namespace hydroprint::pipeline
