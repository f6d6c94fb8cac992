// Compares rendered depths, without noise, with exact formulas.
#include "hardware/simulator/camera/renderer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hardware/simulator/scene/hand.h"
#include "hardware/simulator/scene/rig_layout.h"
#include "hardware/simulator/scene/shapes.h"

namespace hydroprint::simulated_camera {
namespace {

using simulated_scene::Body;
using simulated_scene::Mesh;
using simulated_scene::Scenery;
using simulated_scene::Sight;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Tolerance of exact depths. Rays have single precision, 6e-5 mm at 800 mm.
constexpr double kExact_mm = 2e-3;

/// A half-space n . x <= c.
struct Side {
  Eigen::Vector3d normal;
  double offset;
};

/// Depth at which a ray from a camera enters a convex body; infinite if the ray misses the body.
double entry(const std::vector<Side>& sides, const Eigen::Vector3d& from,
             const Eigen::Vector3d& along) {
  double in = 0, out = kInfinity;
  for (const Side& side : sides) {
    const double rate = side.normal.dot(along);
    const double at = (side.offset - side.normal.dot(from)) / rate;
    (rate < 0 ? in : out) = rate < 0 ? std::max(in, at) : std::min(out, at);
  }
  return in < out ? in : kInfinity;
}

const std::vector<Side> kPyramid = {
    {{4, 0, 3}, 120}, {{-4, 0, 3}, 120}, {{0, 4, 3}, 120}, {{0, -4, 3}, 120}, {{0, 0, -1}, 0}};

Eigen::Vector3d direction(const Lens& lens, const Pose& X_FC, std::size_t pixel) {
  const Eigen::Vector2d at(static_cast<double>(pixel % kWidth_px),
                           static_cast<double>(pixel / kWidth_px));
  return X_FC.linear() * unproject(lens, at).homogeneous();
}

Depths look(const Scenery& scenery, const Lens& lens, const Pose& X_FC, const Sight& sight = {},
            bool lit = false) {
  const auto renderer = Renderer::create(scenery, lens);
  EXPECT_TRUE(renderer);
  return (*renderer)->look(sight, X_FC, lit);
}

Body ground() { return {"ground", simulated_scene::box({-2e3, -2e3, -10}, {2e3, 2e3, 0}), false}; }

TEST(Renderer, APyramidOnAPlaneIsExactWithEveryLens) {
  Scenery scenery;
  scenery.bodies = {ground(), {"pyramid", simulated_scene::pyramid(60, 40), false}};
  const Lens lens = drawn_lens(11);
  simulated_scene::CameraStand stand;
  stand.at_mm = {0, -200, 770};  // so that the camera sees no side at a grazing angle
  const Pose X_FC = simulated_scene::camera_pose(stand, 1, 0);
  const Depths seen = look(scenery, lens, X_FC);
  int on_pyramid = 0, at_its_edge = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Eigen::Vector3d along = direction(lens, X_FC, i);
    const double plane = -X_FC.translation().z() / along.z();
    const double pyramid = entry(kPyramid, X_FC.translation(), along);
    if (pyramid < plane) ++on_pyramid;
    const double miss = std::abs(seen[i] - std::min(plane, pyramid));
    // A ray along the outline of the pyramid may fall on either side of the outline.
    if (miss > kExact_mm) ++at_its_edge;
  }
  EXPECT_GT(on_pyramid, 1500);
  EXPECT_LE(at_its_edge, 2);
}

/// A sphere of triangles with all vertices on it.
Mesh sphere(double radius_mm, int around) {
  Mesh out;
  const int down = around / 2;
  for (int j = 0; j <= down; ++j) {
    for (int i = 0; i < around; ++i) {
      const double a = 2 * M_PI * i / around;
      const double b = M_PI * j / down;
      out.points.emplace_back(radius_mm * std::sin(b) * std::cos(a),
                              radius_mm * std::sin(b) * std::sin(a), radius_mm * std::cos(b));
    }
  }
  for (int j = 0; j < down; ++j) {
    for (int i = 0; i < around; ++i) {
      const int next = (i + 1) % around;
      const int here = j * around;
      out.triangles.emplace_back(here + i, here + around + i, here + next);
      out.triangles.emplace_back(here + next, here + around + i, here + around + next);
    }
  }
  return out;
}

TEST(Renderer, ASphereInTheGripperFollowsTheDrive) {
  constexpr double kRadius_mm = 40;
  Scenery scenery;
  scenery.bodies = {{"sphere", sphere(kRadius_mm, 800), true}};
  const Lens lens = drawn_lens(12);
  const Pose X_FC = simulated_scene::camera_pose({}, 1, 0);
  for (const double height_mm : {150.0, 12.5}) {
    Sight sight;
    sight.gripper_height_mm = height_mm;
    const Depths seen = look(scenery, lens, X_FC, sight);
    int hits = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const Eigen::Vector3d along = direction(lens, X_FC, i);
      const Eigen::Vector3d from = X_FC.translation() - Eigen::Vector3d(0, 0, height_mm);
      const double a = along.squaredNorm();
      const double b = from.dot(along);
      const double root = b * b - a * (from.squaredNorm() - kRadius_mm * kRadius_mm);
      const double facing = root > 0 ? std::sqrt(root / a) / kRadius_mm : 0;
      if (facing < 0.3) continue;  // near the outline, the triangles differ from the sphere
      ++hits;
      // Triangles lie up to R (1 - cos(pi / 800)) = 0.3 um below the sphere.
      ASSERT_NEAR(seen[i], (-b - std::sqrt(root)) / a, 3 * kExact_mm);
    }
    EXPECT_GT(hits, 2000);
  }
}

TEST(Renderer, SurfacesWithoutProjectorLightAreNotMeasured) {
  Scenery scenery;
  const double height_mm = 100;
  scenery.bodies = {ground(),
                    {"box", simulated_scene::box({-50, -50, 0}, {50, 50, height_mm}), false}};
  Pose X_FC = Pose::Identity();
  X_FC.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  X_FC.translation() = Eigen::Vector3d(0, 0, 800);
  const Depths seen = look(scenery, {}, X_FC, {}, true);
  const float* row = &seen[static_cast<std::size_t>(kHeight_px / 2) * kWidth_px];
  int left = 0, right = 0;
  for (int x = 0; x < kWidth_px; ++x) {
    if (row[x] == 0) ++(x < kWidth_px / 2 ? left : right);
  }
  // The top's edge at x = -50 mm shadows the ground up to the point where the projector's ray over
  // the edge lands.
  const double end_mm = 50 + (50 + kBaseline_mm) * height_mm / (800 - height_mm);
  const double start_mm = 50 * 800 / (800 - height_mm);
  EXPECT_NEAR(left, (end_mm - start_mm) * kFocal_px / 800, 1.01);
  EXPECT_EQ(right, 0);
}

TEST(Renderer, SurfacesAtGrazingAnglesAreNotMeasured) {
  Scenery scenery;
  scenery.bodies = {ground()};
  for (const double degrees : {9.0, 11.0}) {
    const double height = 800 * std::sin(degrees * M_PI / 180);
    simulated_scene::CameraStand stand;
    stand.at_mm = {0, -800 * std::cos(degrees * M_PI / 180), height};
    const Depths seen = look(scenery, {}, simulated_scene::camera_pose(stand, 1, 0));
    EXPECT_EQ(seen[static_cast<std::size_t>(kHeight_px / 2) * kWidth_px + kWidth_px / 2] > 0,
              degrees > 10);
  }
}

TEST(Renderer, MarkersAreRenderedInEveryState) {
  Scenery scenery;
  scenery.markers = simulated_scene::nominal_markers({210, 297});
  const Pose X_FC = simulated_scene::camera_pose({}, 1, 0);
  const auto renderer = Renderer::create(scenery, {});
  const auto count = [&](const Sight& sight) {
    const Depths seen = (*renderer)->look(sight, X_FC, false);
    return std::count_if(seen.begin(), seen.end(), [](float z) { return z > 0; });
  };
  Sight sight;
  const auto well = count(sight);
  EXPECT_GT(well, 6000) << "the four marker pyramids must be visible";
  for (const auto state :
       {simulated_scene::MarkerState::kHidden, simulated_scene::MarkerState::kKnockedOver}) {
    sight.markers.assign(4, simulated_scene::MarkerState::kWell);
    sight.markers[2] = state;
    EXPECT_NE(count(sight), well);
  }
  EXPECT_EQ(count({}), well) << "the marker must stand upright again";
}

TEST(Renderer, TheSameSceneSeedTimeAndNumberGiveTheSameBits) {
  Scenery scenery;
  scenery.bodies = simulated_scene::standing_bodies({210, 297});
  scenery.markers = simulated_scene::nominal_markers({210, 297});
  scenery.stand.via_mm = {{200, -300, 700}};
  scenery.seed = 4;
  const auto one = Renderer::create(scenery, lens_of(scenery));
  const auto other = Renderer::create(scenery, lens_of(scenery));
  Sight sight;
  sight.time_s = 3.4;
  const Frame frame = (*one)->photograph(sight, 7);
  EXPECT_NE((*other)->photograph(sight, 8), frame);
  sight.time_s = 1;
  EXPECT_NE((*other)->photograph(sight, 7), frame) << "the hand moves";
  sight.time_s = 3.4;
  EXPECT_EQ((*other)->photograph(sight, 7), frame);
}

}  // namespace
}  // namespace hydroprint::simulated_camera
