#include "hardware/depth_camera/frame_watch.h"

#include <gtest/gtest.h>

namespace hydroprint::depth_camera {
namespace {

DepthFrame frame(std::uint16_t first) {
  DepthFrame out{20, 10, std::vector<std::uint16_t>(200, 800)};
  out.depth_mm[0] = first;
  return out;
}

DepthFrame black() { return {20, 10, std::vector<std::uint16_t>(200, 0)}; }

TEST(FrameWatch, AcceptsFramesThatDifferInOnePixel) {
  FrameWatch watch("camera");
  for (std::uint16_t i = 0; i < 100; ++i) {
    EXPECT_TRUE(watch.look(frame(static_cast<std::uint16_t>(700 + i % 2))));
    EXPECT_TRUE(watch.good());
  }
}

TEST(FrameWatch, TenIdenticalFramesMeanAFrozenCamera) {
  FrameWatch watch("camera");
  for (int i = 0; i < FrameWatch::kMostBad; ++i) {
    EXPECT_TRUE(watch.look(frame(700)));
    EXPECT_EQ(watch.good(), i == 0);
  }
  const Status frozen = watch.look(frame(700));
  ASSERT_FALSE(frozen);
  EXPECT_EQ(frozen.error().reason, ErrorReason::CAMERA_FROZEN);
}

TEST(FrameWatch, TenEmptyFramesMeanABlackCameraButAFewDoNot) {
  FrameWatch watch("camera");
  for (int round = 0; round < 3; ++round) {
    for (int i = 1; i < FrameWatch::kMostBad; ++i) {
      EXPECT_TRUE(watch.look(black()));
      EXPECT_FALSE(watch.good());
    }
    EXPECT_TRUE(watch.look(frame(700)));
    EXPECT_TRUE(watch.good());
  }
  for (int i = 1; i < FrameWatch::kMostBad; ++i) EXPECT_TRUE(watch.look(black()));
  const Status dark = watch.look(black());
  ASSERT_FALSE(dark);
  EXPECT_EQ(dark.error().reason, ErrorReason::CAMERA_BLACK);
}

}  // namespace
}  // namespace hydroprint::depth_camera
