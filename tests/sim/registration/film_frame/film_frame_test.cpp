// The film frame from scans of the four marker pyramids.
#include "sim/registration/film_frame/film_frame.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tests/sim/registration/limits.h"
#include "tests/support/depth_scene.h"

namespace hydroprint::registration {
namespace {

using testing::crooked;
using testing::nominal_layout;
using testing::Rig;

scan::Cloud cloud_of(const std::vector<scan::DepthFrame>& frames, const scan::Lens& lens) {
  auto fused = scan::fuse(frames, {}, testing::two_threads());
  if (!fused) throw std::runtime_error(fused.error().message);
  auto cloud = scan::make_cloud(*fused, {lens}, {}, testing::two_threads());
  if (!cloud) throw std::runtime_error(cloud.error().message);
  return std::move(*cloud);
}

/// The configured pose of a camera that has been moved since.
Pose nominal(const Rig& rig) { return rig.X_CF() * crooked(12 * kDegree, 30, 5); }

Result<FilmFrame> found(const Rig& rig) {
  return find_film_frame(cloud_of({rig.exact()}, testing::lens_of(rig.lens)), nominal_layout(),
                         nominal(rig), testing::two_threads());
}

void expect_pose(const Pose& pose, const Pose& truth, double mm, double rad) {
  const Pose off = pose.inverse() * truth;
  EXPECT_LT(off.translation().norm(), mm);
  EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), rad);
}

TEST(FilmFrame, ExactDepthsGiveTheExactFrame) {
  const Rig rig;
  const auto frame = found(rig);
  ASSERT_TRUE(frame) << frame.error().message;
  expect_pose(frame->X_CF(), rig.X_CF(), 0.02, 1e-4);
  for (const MarkerReport& m : frame->markers) {
    EXPECT_TRUE(m.used) << m.name << ": " << m.why_not;
    EXPECT_LT(m.residual_mm, 0.1) << m.name;
  }
}

TEST(FilmFrame, NoiseStaysWithinTheStatedCovariance) {
  Rig rig;
  int within = 0;
  constexpr int kSeeds = 10;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    rig.stand = testing::stand_at(800, (56 + seed) * kDegree, 0.3 * std::sin(seed * 1.7));
    const auto cloud = cloud_of(rig.frames(5, seed), testing::lens_of(rig.lens));
    const auto frame =
        find_film_frame(cloud, nominal_layout(), nominal(rig), testing::two_threads());
    ASSERT_TRUE(frame) << frame.error().message;
    const Vector6 off = twist_between(frame->X_CF(), rig.X_CF(), frame->fit.centre_mm);
    within += off.dot(frame->fit.covariance.inverse() * off) < kSquare95 ? 1 : 0;
    EXPECT_LT(off.tail<3>().norm(), 0.5);
    EXPECT_LT(off.head<3>().norm(), 0.2 * kDegree);
  }
  EXPECT_GE(within, kSeeds * 9 / 10);
}

/// Message about marker 1, "right", which is wrong: the reason why it is not used, or the error.
std::string left_out(const Rig& rig) {
  const auto frame = found(rig);
  if (!frame) return frame.error().message;
  expect_pose(frame->X_CF(), rig.X_CF(), 0.05, 3e-4);
  EXPECT_EQ(frame->warnings.size(), 1U);
  for (std::size_t a = 0; a < 4; ++a) EXPECT_EQ(frame->markers[a].used, a != 1);
  return frame->markers[1].why_not;
}

TEST(FilmFrame, AMovedMarkerIsLeftOut) {
  Rig rig;
  rig.markers[1].at_mm += Eigen::Vector3d(2, -1.5, 0);
  EXPECT_NE(left_out(rig).find("2.5 mm from its configured position"), std::string::npos);
  rig.markers[1].at_mm += Eigen::Vector3d(8, -6, 0);
  EXPECT_NE(left_out(rig).find("12.5 mm from its configured position"), std::string::npos);
}

TEST(FilmFrame, AToppledMarkerIsLeftOut) {
  Rig rig;
  rig.states[1] = simulated_scene::MarkerState::kKnockedOver;
  EXPECT_NE(left_out(rig).find("knocked over"), std::string::npos);
}

TEST(FilmFrame, ACoveredMarkerIsLeftOut) {
  Rig rig;
  rig.states[1] = simulated_scene::MarkerState::kHidden;
  EXPECT_NE(left_out(rig).find("hidden"), std::string::npos);
}

TEST(FilmFrame, AMissingMarkerIsLeftOut) {
  Rig rig;
  rig.markers.erase(rig.markers.begin() + 1);
  EXPECT_NE(left_out(rig).find("missing"), std::string::npos);
}

TEST(FilmFrame, AMarkerWithALumpOnItIsLeftOut) {
  Rig rig;
  const Eigen::Vector3d at = rig.markers[1].at_mm;
  rig.more = {
      testing::body_of(testing::box({-30, -30, 0}, {30, 0, 25}), Pose(Eigen::Translation3d(at)))};
  EXPECT_NE(left_out(rig), "");
}

TEST(FilmFrame, ThreeMarkersThatDoNotAgreeAreRefused) {
  Rig rig;
  rig.markers.erase(rig.markers.begin() + 3);
  rig.markers[1].at_mm += Eigen::Vector3d(4, 3, 0);
  const auto frame = found(rig);
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error().reason, ErrorReason::TOO_FEW_MARKERS);
}

TEST(FilmFrame, FewerThanThreeMarkersAreRefusedByName) {
  Rig rig;
  rig.markers.erase(rig.markers.begin(), rig.markers.begin() + 2);
  const auto frame = found(rig);
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error().reason, ErrorReason::TOO_FEW_MARKERS);
  EXPECT_NE(frame.error().message.find("\"left\""), std::string::npos);
  EXPECT_NE(frame.error().message.find("\"right\""), std::string::npos);
  EXPECT_EQ(frame.error().message.find("\"near\""), std::string::npos);
}

TEST(FilmFrame, AFrameWithoutWaterIsRefused) {
  const Rig rig;
  const auto cloud = cloud_of({rig.exact()}, testing::lens_of(rig.lens));
  const Pose on_its_side = rig.X_CF() * Eigen::AngleAxisd(90 * kDegree, Eigen::Vector3d::UnitX());
  const auto frame = find_film_frame(cloud, nominal_layout(), on_its_side, testing::two_threads());
  ASSERT_FALSE(frame);
  EXPECT_EQ(frame.error().reason, ErrorReason::NO_PLANE);
}

}  // namespace
}  // namespace hydroprint::registration
