// A camera swept over the rig, compared with its true path and the true scene.
#include "sim/scan/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "hardware/simulator/camera/sensor.h"
#include "hardware/simulator/scene/shapes.h"
#include "sim/registration/shape.h"
#include "tests/support/depth_scene.h"
#include "tests/support/swept_camera.h"

namespace hydroprint::scan {
namespace {

using Eigen::Vector3d;
using testing::SweptCamera;
using testing::two_threads;

std::vector<simulated_scene::Body> block() {
  return {{"block", simulated_scene::box({-40, -25, 30}, {35, 30, 90}), false}};
}

std::vector<double> times_of(const std::vector<DepthFrame>& frames) {
  std::vector<double> out;
  for (std::size_t i = 0; i < frames.size(); ++i) out.push_back(static_cast<double>(i) / 30);
  return out;
}

Result<Sweep> fuse(const std::vector<DepthFrame>& frames, const Camera& camera,
                   const Context& context = two_threads()) {
  const std::vector<double> times_s = times_of(frames);
  return fuse_sweep({frames, times_s, camera, {}, {}}, context);
}
Result<Sweep> fuse(const std::vector<DepthFrame>& frames, const Lens& lens,
                   const Context& context = two_threads()) {
  return fuse(frames, Camera{lens}, context);
}

/// The exact fixed pattern of a camera, as the best possible result of calibrate-camera.
FixedPattern pattern_of(std::uint64_t seed) {
  FixedPattern out{640, 480, 4, simulated_camera::constant_noise(seed)};
  out.sigma.assign(out.patches(), 0);
  return out;
}

/// Largest position error of the tracked camera.
double farthest_mm(const Sweep& sweep, const SweptCamera& camera) {
  double out = 0;
  for (std::size_t i = 0; i < sweep.path.X_WC.size(); ++i) {
    if (!sweep.path.is_placed[i]) continue;
    const Pose truth = camera.X_FC(0).inverse() * camera.X_FC(static_cast<int>(i));
    out = std::max(out, (sweep.path.X_WC[i].translation() - truth.translation()).norm());
  }
  return out;
}

/// Error of the fused surface over the given share of its points, those with the smallest errors.
double surface_mm(const Sweep& sweep, const SweptCamera& camera, double share) {
  const registration::Shape truth(camera.scene());
  const double sigma_mm = DepthNoise{}.sigma_mm(800);
  std::vector<double> off;
  for (const Vector3d& p : sweep.volume.surface(3 / (sigma_mm * sigma_mm)).points_mm) {
    const Vector3d p_F = camera.X_FC(0) * p;
    off.push_back((truth.closest(p_F).point_mm - p_F).norm());
  }
  EXPECT_GT(off.size(), 100000U);
  std::sort(off.begin(), off.end());
  return off[static_cast<std::size_t>(share * static_cast<double>(off.size() - 1))];
}

TEST(Sweep, TracksACameraWithoutErrors) {
  const SweptCamera camera(block(), 4, false);
  const auto sweep = fuse(camera.frames(10), camera.lens());
  ASSERT_TRUE(sweep) << sweep.error().message;
  EXPECT_EQ(sweep->path.lost(), 0U);
  EXPECT_LT(farthest_mm(*sweep, camera), 0.3);
}

TEST(Sweep, TracksACameraWithAllErrorsAndFindsTheSurface) {
  const SweptCamera camera(block());
  const auto sweep = fuse(camera.frames(25), camera.lens());
  ASSERT_TRUE(sweep) << sweep.error().message;
  EXPECT_EQ(sweep->path.lost(), 0U);
  EXPECT_LT(farthest_mm(*sweep, camera), 0.6);
  EXPECT_LT(surface_mm(*sweep, camera, 0.5), 0.4);
}

TEST(Sweep, SubtractsTheCamerasFixedPattern) {
  constexpr std::uint64_t kSeed = 4;
  const SweptCamera camera(block(), kSeed);
  const auto frames = camera.frames(10);
  const auto as_they_are = fuse(frames, camera.lens());
  const auto taken_off = fuse(frames, Camera{camera.lens(), {}, pattern_of(kSeed)});
  ASSERT_TRUE(as_they_are && taken_off);
  EXPECT_LT(taken_off->path.rms_mm, 0.8 * as_they_are->path.rms_mm);
  EXPECT_LT(surface_mm(*taken_off, camera, 0.5), 0.8 * surface_mm(*as_they_are, camera, 0.5));
  FixedPattern other = pattern_of(kSeed);
  other.width_px = 320;
  const auto refused = fuse(frames, Camera{camera.lens(), {}, other});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("fixed pattern is for 320 x 480"), std::string::npos)
      << refused.error().message;
}

TEST(Sweep, IsTheSameForAnyNumberOfThreads) {
  const SweptCamera camera(block());
  const auto frames = camera.frames(7);
  const auto one = fuse(frames, camera.lens(), {});
  const auto two = fuse(frames, camera.lens());
  ASSERT_TRUE(one && two);
  for (std::size_t i = 0; i < frames.size(); ++i)
    EXPECT_EQ(one->path.X_WC[i].matrix(), two->path.X_WC[i].matrix());
  EXPECT_EQ(one->volume.surface().points_mm, two->volume.surface().points_mm);
}

TEST(Sweep, NamesTheFrameThatWasLost) {
  const SweptCamera camera(block());
  std::vector<DepthFrame> frames = camera.frames(4);
  // The camera is turned to a wall.
  for (int i = 0; i < 12; ++i) frames.push_back(testing::wall_frame(600));
  const auto lost = fuse(frames, camera.lens());
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.error().reason, ErrorReason::CAMERA_LOST);
  EXPECT_EQ(lost.error().message.rfind("depth frame 14 of 16 (at 0.4 s): ", 0), 0U)
      << lost.error().message;
}

/// After a jump, each frame must be either lost or placed correctly.
TEST(Sweep, LosesFramesAfterAJumpRatherThanMisplaceThem) {
  const SweptCamera camera(block());
  // During the skipped frames, the camera moves by 50 mm and by 0.5 m.
  for (const int jump : {9, 70}) {
    std::vector<DepthFrame> frames = camera.frames(4);
    for (int i = 0; i < 2; ++i) frames.push_back(camera.frame(3 + jump + i));
    const auto sweep = fuse(frames, camera.lens());
    ASSERT_TRUE(sweep) << sweep.error().message;
    for (std::size_t i = 4; i < frames.size(); ++i) {
      if (!sweep->path.is_placed[i]) continue;
      const Pose truth = camera.X_FC(0).inverse() * camera.X_FC(static_cast<int>(i) - 1 + jump);
      EXPECT_LT((sweep->path.X_WC[i].translation() - truth.translation()).norm(), 1)
          << "frame " << i << " after a jump of " << jump;
    }
  }
}

TEST(Sweep, RelocalisesAfterFramesThatShowNothing) {
  const SweptCamera camera(block());
  std::vector<DepthFrame> frames = camera.frames(6);
  frames[4] = testing::wall_frame(600);
  const auto sweep = fuse(frames, camera.lens());
  ASSERT_TRUE(sweep) << sweep.error().message;
  EXPECT_EQ(sweep->path.is_placed, (std::vector<bool>{true, true, true, true, false, true}));
  EXPECT_LT(farthest_mm(*sweep, camera), 0.6);
}

TEST(Sweep, RefusesFramesOfAFaultyCamera) {
  const Lens lens;
  const DepthFrame dark{640, 480, std::vector<float>(640 * 480)};
  const DepthFrame flat = testing::wall_frame(800);
  const auto reason = [&](const std::vector<DepthFrame>& frames) {
    const auto sweep = fuse(frames, lens);
    return std::string(sweep ? "" : name_of(sweep.error().reason));
  };
  EXPECT_EQ(reason({dark, flat}), "CAMERA_BLACK");
  EXPECT_EQ(reason({flat, flat, flat}), "CAMERA_FROZEN");
  std::vector<DepthFrame> wall(12, flat);
  for (std::size_t i = 0; i < wall.size(); ++i) wall[i].depth_mm[i] = 810;
  EXPECT_EQ(reason(wall), "CAMERA_LOST");  // a plane does not determine motion along itself
  EXPECT_FALSE(fuse({}, lens));
  Lens other;
  other.width_px = 320;
  EXPECT_FALSE(fuse({dark, flat}, other));
  const std::vector<DepthFrame> frames{flat, wall[1]};
  EXPECT_FALSE(fuse_sweep({frames, std::vector<double>{0, 0}, {lens}, {}, {}}, {}));
}

TEST(Sweep, StopsWhenCancelled) {
  const SweptCamera camera(block());
  Context context;
  context.cancelled = [] { return true; };
  const auto sweep = fuse(camera.frames(2), camera.lens(), context);
  ASSERT_FALSE(sweep);
  EXPECT_EQ(sweep.error().code, Code::kCancelled);
}

}  // namespace
}  // namespace hydroprint::scan
