#include "hardware/simulator/camera/lens.h"

#include <gtest/gtest.h>

namespace hydroprint::simulated_camera {
namespace {

TEST(Lens, UnprojectInvertsProjectAcrossTheWholeFrame) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Lens lens = drawn_lens(seed);
    for (int y = 0; y < kHeight_px; y += 479) {
      for (int x = 0; x < kWidth_px; x += 71) {
        const Eigen::Vector2d pixel(x, y);
        const Eigen::Vector2d back = project(lens, unproject(lens, pixel));
        ASSERT_LT((back - pixel).norm(), 1e-9) << seed << ": " << pixel.transpose();
      }
    }
  }
}

TEST(Lens, TheManufacturersLensIsAPinhole) {
  const Eigen::Vector2d corner = unproject(Lens{}, {-0.5, -0.5});
  EXPECT_NEAR(corner.x(), -std::tan(horizontal_fov_rad() / 2), 1e-12);
  EXPECT_NEAR(corner.y(), -std::tan(vertical_fov_rad() / 2), 1e-12);
  EXPECT_NEAR(horizontal_fov_rad() * 180 / M_PI, 58.1, 0.1);
}

TEST(Lens, CamerasDifferAndAreReproducible) {
  double least = 1, most = 1;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Lens lens = drawn_lens(seed);
    EXPECT_EQ(lens.k1, drawn_lens(seed).k1);
    EXPECT_LE(std::abs(lens.focal_px / kFocal_px - 1), 0.02);
    EXPECT_LE((lens.centre_px - Lens{}.centre_px).cwiseAbs().maxCoeff(), 8);
    least = std::min(least, lens.depth_scale);
    most = std::max(most, lens.depth_scale);
  }
  EXPECT_LT(least, 0.991);
  EXPECT_GT(most, 1.009);
}

}  // namespace
}  // namespace hydroprint::simulated_camera
