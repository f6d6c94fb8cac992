#include "sim/scan/lens.h"

#include <gtest/gtest.h>

namespace hydroprint::scan {
namespace {

Lens bent() {
  Lens lens;
  lens.fx_px = 580;
  lens.fy_px = 577;
  lens.cx_px = 322;
  lens.cy_px = 237;
  lens.k1 = -0.08;
  lens.k2 = 0.05;
  lens.p1 = 0.002;
  lens.p2 = -0.003;
  lens.depth_scale = 1.01;
  return lens;
}

TEST(Lens, PixelsAndRaysAreConsistent) {
  const Lens lens = bent();
  for (const double u : {0.0, 100.5, 320.0, 639.0}) {
    for (const double v : {0.0, 47.25, 240.0, 479.0}) {
      const Eigen::Vector2d pixel = lens.project(lens.point(u, v, 800));
      EXPECT_NEAR(pixel.x(), u, 1e-9);
      EXPECT_NEAR(pixel.y(), v, 1e-9);
    }
  }
}

TEST(Lens, DepthIsAlongTheAxisTimesScale) {
  EXPECT_NEAR(bent().point(500, 20, 1000).z(), 1.01 * 1000, 1e-9);
}

TEST(Lens, DerivativesMatchSmallChanges) {
  const Lens lens = bent();
  Lens::Vector change;
  change << 0.3, -0.2, 0.1, 0.2, 1e-3, -2e-3, 2e-4, 1e-4, 5e-4;
  const Lens changed = lens.with(lens.parameters() + change);
  const Eigen::Vector3d moved = changed.point(600, 30, 900) - lens.point(600, 30, 900);
  EXPECT_LT((moved - lens.derivatives(600, 30, 900) * change).norm(), 0.01 * moved.norm());
}

}  // namespace
}  // namespace hydroprint::scan
