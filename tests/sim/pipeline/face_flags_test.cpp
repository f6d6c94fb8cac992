#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "sim/pipeline/pipeline.h"
#include "sim/sample/icosphere.h"
#include "tests/sim/pipeline/dips.h"
#include "tests/sim/support/bodies.h"

// The flags of faces, the property of surface_map.ply.

namespace hydroprint::pipeline {
namespace {

namespace bodies = hydroprint::testing;

using testing::dipped;
using testing::options_for;

bool has(const Dip& dip, std::size_t t, FaceFlag flag) { return (dip.face_flags[t] & flag) != 0; }

/// Returns the corners of a face in the film frame; z is the immersion.
std::array<Eigen::Vector3d, 3> corners(const Dip& dip, std::size_t t) {
  std::array<Eigen::Vector3d, 3> out;
  for (int k = 0; k < 3; ++k) out[k] = dip.X_FO * dip.surface.points[dip.surface.triangles[t][k]];
  return out;
}

Eigen::Vector3d area_vector(const Dip& dip, std::size_t t) {
  const auto [a, b, c] = corners(dip, t);
  return 0.5 * (b - a).cross(c - a);
}

/// Returns the share of the surface whose faces have a flag.
double share(const Dip& dip, FaceFlag flag) {
  double total_mm2 = 0, flagged_mm2 = 0;
  for (std::size_t t = 0; t < dip.face_flags.size(); ++t) {
    const double area_mm2 = area_vector(dip, t).norm();
    total_mm2 += area_mm2;
    if (has(dip, t, flag)) flagged_mm2 += area_mm2;
  }
  return flagged_mm2 / total_mm2;
}

/// Returns whether a condition holds at a corner of a face.
template <class Test>
bool any_corner(const Dip& dip, std::size_t t, Test test) {
  const Eigen::Vector3i& v = dip.surface.triangles[t];
  return test(v[0]) || test(v[1]) || test(v[2]);
}

/// Every face has exactly the flags that the columns of its corners and its angle tell.
void expect_flags_of_columns(const Dip& dip, const film::Profile& profile) {
  const flow::SurfaceMap& map = dip.map.surface;
  ASSERT_EQ(dip.face_flags.size(), dip.surface.triangles.size());
  for (std::size_t t = 0; t < dip.face_flags.size(); ++t) {
    const bool faces_up =
        area_vector(dip, t).normalized().z() > std::cos(10 * std::numbers::pi / 180);
    const bool is_bare = any_corner(dip, t, [&](int v) { return std::isnan(map.film_mm[v].x()); });
    EXPECT_EQ(has(dip, t, kClamped), faces_up) << t;
    EXPECT_EQ(has(dip, t, kNotReached), is_bare) << t;
    EXPECT_EQ(has(dip, t, kTorn),
              any_corner(dip, t, [&](int v) { return map.stretch[v] > profile.tear_stretch; }))
        << t;
    EXPECT_EQ(
        has(dip, t, kWrinkled),
        any_corner(dip, t, [&](int v) { return map.least_stretch[v] < profile.wrinkle_stretch; }))
        << t;
    EXPECT_EQ(has(dip, t, kNoAnswer),
              any_corner(dip, t, [&](int v) { return std::isinf(map.error_mm[v]); }))
        << t;
  }
}

/// A sphere of 20 mm radius, dipped to this contact angle.
Dip sphere_to(double theta_deg, const film::Profile& profile, FilmModel model) {
  DipOptions options = options_for("200x200", model);
  options.profile = profile;
  options.depth_mm = 20 * (1 - std::cos(theta_deg * std::numbers::pi / 180));
  return dipped(sample::icosphere(20, 4), options);
}

TEST(FaceFlags, OfADeeplyDippedSphereAreTheSharesOfTheReport) {
  for (const FilmModel model : {FilmModel::kStokes, FilmModel::kSheet}) {
    film::Profile profile;
    profile.tear_stretch = 1.8;
    const Dip torn = sphere_to(120, profile, model);
    expect_flags_of_columns(torn, profile);
    // A face has a flag if the report counts a third of it.
    const auto expect_share = [&](FaceFlag flag, double of_report) {
      EXPECT_GT(share(torn, flag), of_report);
      EXPECT_LT(share(torn, flag), of_report + 0.08);
    };
    EXPECT_GT(torn.figures.torn_share, 0.05);
    expect_share(kTorn, torn.figures.torn_share);
    expect_share(kWrinkled, torn.figures.wrinkled_share);
    EXPECT_NEAR(share(torn, kClamped), torn.figures.clamped_share, 1e-9);
    EXPECT_EQ(share(torn, kTrappedAir), 0);
    const Dip shallow = sphere_to(60, film::Profile(), model);
    for (const FaceFlag flag : {kTorn, kWrinkled, kTrappedAir}) EXPECT_EQ(share(shallow, flag), 0);
  }
}

TEST(FaceFlags, SayThatThereIsNoAnswerBehindTearsOfTheSheet) {
  film::Profile profile;
  EXPECT_LT(share(sphere_to(100, profile, FilmModel::kSheet), kNoAnswer), 0.01);
  profile.tear_stretch = 1.5;
  const Dip torn = sphere_to(120, profile, FilmModel::kSheet);
  EXPECT_NEAR(share(torn, kNoAnswer), torn.figures.error->no_bound_share * torn.figures.coverage,
              0.08);
  EXPECT_GT(share(torn, kNoAnswer), 0.05);
}

TEST(FaceFlags, OfPartsThatStayDryAreNotReached) {
  const mesh::Model spindle = bodies::turned({{0, 0}, {24, 24}, {0, 48}}, 48);
  DipOptions options = options_for("150x150", FilmModel::kStokes);
  options.depth_mm = 24;
  const Dip half = dipped(spindle, options);
  expect_flags_of_columns(half, options.profile);
  EXPECT_NEAR(share(half, kNotReached), 1 - half.figures.coverage, 0.06);
  EXPECT_EQ(share(half, kTrappedAir), 0);
}

// --- trapped air

constexpr double kMouth_mm = 14, kSide_mm = 4, kTall_mm = 40;

mesh::Model cup(double tilt_rad, double vent_mm) {
  return bodies::tilted(
      bodies::cup(kMouth_mm, kMouth_mm + kSide_mm, kTall_mm, kSide_mm, false, 96, vent_mm),
      tilt_rad);
}

TEST(FaceFlags, OfTheInsideOfACupMouthDownAreTrappedAir) {
  const DipOptions options = options_for("120x120", FilmModel::kStokes);
  for (const double tilt_rad : {0.0, 0.35}) {
    const Dip closed = dipped(cup(tilt_rad, 0), options);
    expect_flags_of_columns(closed, options.profile);
    // The mouth closes at the highest point of its inner edge.
    const double closed_mm = (2 * kMouth_mm + kSide_mm) * std::sin(tilt_rad);
    for (std::size_t t = 0; t < closed.face_flags.size(); ++t) {
      const auto [a, b, c] = corners(closed, t);
      const Eigen::Vector3d middle = (a + b + c) / 3, outward = area_vector(closed, t).normalized();
      // Upright, with the mouth at z = 0.
      const auto upright = [&](const Eigen::Vector3d& p) {
        return Eigen::Vector3d(Eigen::AngleAxisd(-tilt_rad, Eigen::Vector3d::UnitX()) *
                               (closed.X_FO.inverse() * p));
      };
      const Eigen::Vector3d in_front = upright(middle + 0.01 * outward);
      const bool is_inside = in_front.head<2>().norm() < kMouth_mm && in_front.z() > 0 &&
                             in_front.z() < kTall_mm - kSide_mm;
      if (std::abs(middle.z() - closed_mm) < 2) continue;
      EXPECT_EQ(has(closed, t, kTrappedAir), is_inside && middle.z() > closed_mm) << t;
    }
  }
}

TEST(FaceFlags, OfAVentedCupHaveNoTrappedAir) {
  const DipOptions options = options_for("120x120", FilmModel::kStokes);
  EXPECT_EQ(share(dipped(cup(0, 1), options), kTrappedAir), 0);
  EXPECT_EQ(share(dipped(bodies::cup(14, 18, 24, 4, true, 64), options), kTrappedAir), 0);
}

TEST(FaceFlags, OfATiltedCupWithAVentInTheMiddleAreTrappedAirOnlyAboveTheVent) {
  const double tilt_rad = 0.35;
  const Dip vented = dipped(cup(tilt_rad, 1), options_for("120x120", FilmModel::kStokes));
  double vent_mm = 0;  // immersion of the vent's lower end
  testing::for_each_point(vented, [&](const Eigen::Vector3d& p, const Eigen::Vector2d&) {
    const Eigen::Vector3d upright =
        Eigen::AngleAxisd(-tilt_rad, Eigen::Vector3d::UnitX()) * (vented.X_FO.inverse() * p);
    const bool is_end =
        upright.head<2>().norm() < 1.01 && std::abs(upright.z() - (kTall_mm - kSide_mm)) < 1e-6;
    if (is_end) vent_mm = std::max(vent_mm, p.z());
  });
  ASSERT_GT(vent_mm, 0);
  EXPECT_GT(share(vented, kTrappedAir), 0.01);
  for (std::size_t t = 0; t < vented.face_flags.size(); ++t) {
    if (!has(vented, t, kTrappedAir)) continue;
    const auto [a, b, c] = corners(vented, t);
    EXPECT_GT((a + b + c).z() / 3, vent_mm - 0.3) << t;
  }
}

}  // namespace
}  // namespace hydroprint::pipeline
