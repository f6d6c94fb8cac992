// Signed distances fused from exact frames, compared with the scene in the frames.
#include "sim/scan/volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>

namespace hydroprint::scan {
namespace {

using Eigen::Vector3d;

Lens small_lens() {
  Lens out;
  out.width_px = 160;
  out.height_px = 120;
  out.fx_px = out.fy_px = 144;
  out.cx_px = 79.5;
  out.cy_px = 59.5;
  out.k1 = -0.1;
  out.depth_scale = 1.01;
  return out;
}

/// Distance along a ray (from, unit direction) to a surface; nullopt if the ray misses it.
using Surface = std::function<std::optional<double>(const Vector3d&, const Vector3d&)>;

const Vector3d kMiddle(10, -20, 800);
constexpr double kRadius_mm = 120;

std::optional<double> meets_ball(const Vector3d& from, const Vector3d& along) {
  const Vector3d to = kMiddle - from;
  const double middle = to.dot(along);
  const double left = kRadius_mm * kRadius_mm - (to.squaredNorm() - middle * middle);
  if (left < 0) return std::nullopt;
  return middle - std::sqrt(left);
}

const Vector3d kNormal = Vector3d(0.4, -0.3, -1).normalized();

std::optional<double> plane(const Vector3d& from, const Vector3d& along) {
  return kNormal.dot(kMiddle - from) / kNormal.dot(along);
}

DepthFrame seen(const Surface& surface, const Optics& optics, const Pose& X_WC) {
  DepthFrame out{optics.lens.width_px, optics.lens.height_px, {}};
  for (const Vector3d& ray : optics.rays) {
    const auto way = surface(X_WC.translation(), X_WC.linear() * ray.normalized());
    out.depth_mm.push_back(way ? static_cast<float>(*way / ray.norm() / optics.lens.depth_scale)
                               : 0);
  }
  return out;
}

Pose from_the_side(double angle_rad) {
  Pose out(Eigen::Translation3d(kMiddle) * Eigen::AngleAxisd(angle_rad, Vector3d::UnitY()) *
           Eigen::Translation3d(-kMiddle));
  return out;
}

Volume around(const Volume::Options& options = {}) {
  const Vector3d half = Vector3d::Constant(300);
  return Volume(Eigen::AlignedBox3d(kMiddle - half, kMiddle + half), options);
}

Volume fused(const Surface& surface, const Optics& optics) {
  Volume out = around();
  for (const double angle : {-0.4, 0.0, 0.4}) {
    const Pose X_WC = from_the_side(angle);
    EXPECT_TRUE(out.add(seen(surface, optics, X_WC), optics, {}, X_WC, {}));
  }
  return out;
}

/// A point uses the depth of the nearest pixel, so its error is at most the plane's slope times
/// half a pixel (4 mm from corner to middle). The errors cancel on average.
TEST(Volume, ReproducesAPlaneToWithinPixels) {
  const Volume volume = fused(plane, Optics(small_lens()));
  int asked = 0;
  double sum = 0;
  for (int i = -8; i <= 8; ++i) {
    for (int j = -8; j <= 8; ++j) {
      const Vector3d across =
          12 * (i * kNormal.unitOrthogonal() + j * kNormal.cross(kNormal.unitOrthogonal()));
      const auto distance = volume.distance_mm(kMiddle + across);
      if (!distance) continue;
      ++asked;
      sum += *distance;
      EXPECT_NEAR(*distance, 0, 2);
    }
  }
  EXPECT_GT(asked, 250);
  EXPECT_NEAR(sum / asked, 0, 0.05);
}

/// Pixels are 5.6 mm wide here, and the surface within each pixel is treated as flat.
TEST(Volume, SurfaceAndViewOfABallAreOnTheBall) {
  const Optics optics(small_lens());
  const Volume volume = fused(meets_ball, optics);
  const TriangleMesh mesh = volume.surface();
  ASSERT_GT(mesh.points_mm.size(), 5000U);
  double squares = 0;
  for (const Vector3d& p : mesh.points_mm) {
    const double off = (p - kMiddle).norm() - kRadius_mm;
    EXPECT_LT(std::abs(off), 4);
    squares += off * off;
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(mesh.points_mm.size())), 0.7);

  const auto view = volume.look(optics, Pose::Identity(), {});
  ASSERT_TRUE(view);
  int hits = 0;
  for (const Vector3d& p : view->points) {
    if (p.z() <= 0) continue;
    ++hits;
    EXPECT_NEAR((p - kMiddle).norm(), kRadius_mm, 4);
  }
  EXPECT_GT(hits, 1000);
}

constexpr double kBehind_mm = 950;
const Vector3d kDisc(0, 0, 800);
constexpr double kDiscRadius_mm = 60;

/// Distance along a ray to a disc in front of a wall.
std::optional<double> disc(const Vector3d& from, const Vector3d& along) {
  const double way = (kDisc.z() - from.z()) / along.z();
  const bool is_hit = (from + way * along - kDisc).norm() < kDiscRadius_mm;
  return is_hit ? way : (kBehind_mm - from.z()) / along.z();
}

/// There must be no surface between an edge and the background seen past it.
TEST(Volume, HasNoSurfaceBehindAnEdge) {
  const Optics optics(small_lens());
  Volume volume = around();
  ASSERT_TRUE(volume.add(seen(disc, optics, Pose::Identity()), optics, {}, Pose::Identity(), {}));
  int on_disc = 0;
  for (const Vector3d& p : volume.surface().points_mm) {
    const bool is_disc = std::abs(p.z() - kDisc.z()) < 2;
    on_disc += is_disc ? 1 : 0;
    EXPECT_TRUE(is_disc || std::abs(p.z() - kBehind_mm) < 2) << p.transpose();
    EXPECT_TRUE(!is_disc || (p - kDisc).norm() < kDiscRadius_mm + 6);  // a pixel is 5.6 mm wide
  }
  EXPECT_GT(on_disc, 1000);
}

std::optional<double> wall(const Vector3d& from, const Vector3d& along) {
  return (kMiddle.z() - from.z()) / along.z();
}

TEST(Volume, SlopesAwayFromAWallAlongTheRays) {
  const Optics optics(small_lens());
  Volume volume = around();
  ASSERT_TRUE(volume.add(seen(wall, optics, Pose::Identity()), optics, {}, Pose::Identity(), {}));
  const auto slope = volume.slope(kMiddle - Vector3d(0, 0, 2), 3);
  ASSERT_TRUE(slope);
  EXPECT_NEAR(slope->distance_mm, 2, 0.01);
  EXPECT_LT((slope->gradient + Vector3d::UnitZ()).norm(), 0.01);
  EXPECT_FALSE(volume.slope(kMiddle - Vector3d(0, 0, 11), 3));  // beyond the truncation distance
  EXPECT_FALSE(volume.slope(Vector3d::Zero(), 3));
}

TEST(Volume, RemovesSurfacesThatItSeesThrough) {
  const Optics optics(small_lens());
  Volume volume = around();
  const DepthFrame with = seen(meets_ball, optics, Pose::Identity());
  DepthFrame without = seen(plane, optics, Pose::Identity());
  for (float& depth : without.depth_mm) depth += 100;
  ASSERT_TRUE(volume.add(with, optics, {}, Pose::Identity(), {}));
  const Vector3d front = kMiddle - Vector3d(0, 0, kRadius_mm);
  EXPECT_NEAR(volume.distance_mm(front).value_or(9), 0, 1);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(volume.add(without, optics, {}, Pose::Identity(), {}));
  EXPECT_GT(volume.distance_mm(front).value_or(0), 3);
}

TEST(Volume, RefusesTooManyVoxelsAndALensOfAnotherSize) {
  const Optics optics(small_lens());
  Volume::Options options;
  options.most_blocks = 20;
  Volume volume = around(options);
  const DepthFrame frame = seen(plane, optics, Pose::Identity());
  const Status large = volume.add(frame, optics, {}, Pose::Identity(), {});
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, Code::kResourceExhausted);
  EXPECT_FALSE(volume.add(frame, Optics(Lens{}), {}, Pose::Identity(), {}));
}

}  // namespace
}  // namespace hydroprint::scan
