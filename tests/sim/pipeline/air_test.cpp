#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "sim/pipeline/dip.h"
#include "sim/pipeline/pipeline.h"
#include "sim/sample/icosphere.h"
#include "tests/sim/pipeline/dips.h"
#include "tests/sim/support/bodies.h"

// Surface that stays bare because air keeps the film away from it, and air under level faces.

namespace hydroprint::pipeline {
namespace {

namespace bodies = hydroprint::testing;

constexpr double kInner_mm = 14, kHeight_mm = 40, kWall_mm = 4;

Dip dipped_cup(double tilt_rad, double vent_mm) {
  const mesh::Model cup =
      bodies::cup(kInner_mm, kInner_mm + kWall_mm, kHeight_mm, kWall_mm, false, 96, vent_mm);
  return testing::dipped(bodies::tilted(cup, tilt_rad),
                         testing::options_for("120x120", FilmModel::kStokes));
}

/// Area of a cup's wall and ceiling above the waterline that closes its mouth, over its surface.
double bare_share(double tilt_rad) {
  constexpr double kPi = std::numbers::pi;
  const double outer_mm = kInner_mm + kWall_mm;
  const double depth_mm = kHeight_mm - kWall_mm;
  // The mouth closes at the highest point of its inner edge. Along the wall, the surface between
  // the mouth and that level is on average as high as the radius times the tangent of the tilt.
  const double wetted_mm = kInner_mm * std::tan(tilt_rad);
  const double inside_mm2 = 2 * kPi * kInner_mm * depth_mm + kPi * kInner_mm * kInner_mm;
  const double outside_mm2 = 2 * kPi * outer_mm * kHeight_mm + kPi * outer_mm * outer_mm +
                             kPi * (outer_mm * outer_mm - kInner_mm * kInner_mm);
  return (inside_mm2 - 2 * kPi * kInner_mm * wetted_mm) / (inside_mm2 + outside_mm2);
}

Warning warning_of_level_face(const Dip& dip) {
  for (const Warning& w : dip.warnings) {
    if (w.code == WarningCode::AIR_TRAPPED && w.message.find("level face") != std::string::npos)
      return w;
  }
  return {};
}

TEST(Air, LeavesTheInsideOfACupBare) {
  for (const double tilt_deg : {0.0, 20.0, 35.0}) {
    const double tilt_rad = tilt_deg * std::numbers::pi / 180;
    // If it is tilted, film reaches all of the outside; otherwise not the level top.
    const double all = tilt_deg > 0 ? 1 : dipped_cup(0, 1).figures.coverage;
    EXPECT_NEAR(all - dipped_cup(tilt_rad, 0).figures.coverage, bare_share(tilt_rad), 0.01)
        << tilt_deg;
  }
}

TEST(Air, DoesNotMoveTheFilmThatLandsOutside) {
  const double tilt_rad = 0.35;
  const Dip vented = dipped_cup(tilt_rad, 1), closed = dipped_cup(tilt_rad, 0);
  const auto outer_wall = [&](const Dip& dip) {
    std::map<std::array<long, 3>, Eigen::Vector2d> film;  // by the place in micrometres
    testing::for_each_point(dip, [&](const Eigen::Vector3d& p, const Eigen::Vector2d& f) {
      const Eigen::Vector3d o = dip.X_FO.inverse() * p;
      const Eigen::Vector3d upright = Eigen::AngleAxisd(-tilt_rad, Eigen::Vector3d::UnitX()) * o;
      const bool is_wall = upright.head<2>().norm() > kInner_mm + 0.9 * kWall_mm;
      if (!is_wall || p.z() > 30 || !f.allFinite()) return;
      film[{std::lround(1e3 * o.x()), std::lround(1e3 * o.y()), std::lround(1e3 * o.z())}] = f;
    });
    return film;
  };
  const auto with_vent = outer_wall(vented), without_vent = outer_wall(closed);
  double square_mm2 = 0;
  int count = 0;
  for (const auto& [place, film] : without_vent) {
    const auto same = with_vent.find(place);
    if (same == with_vent.end()) continue;
    square_mm2 += (same->second - film).squaredNorm();
    ++count;
  }
  ASSERT_GT(count, 500);
  EXPECT_LT(std::sqrt(square_mm2 / count), 0.05);  // half a pixel at 300 dpi
}

TEST(Air, UnderALevelFaceIsReportedWithItsAreaAndPlace) {
  const DipOptions options = testing::options_for("100x90", FilmModel::kStokes);
  const mesh::Model box = bodies::box({-15, -10, 0}, {15, 10, 20});
  const Warning flat = warning_of_level_face(testing::dipped(box, options));
  EXPECT_NE(flat.message.find("600 mm2"), std::string::npos) << flat.message;
  EXPECT_NE(flat.message.find("Tilt"), std::string::npos) << flat.message;
  EXPECT_TRUE(words_of(flat.where).starts_with("0.00 mm immersion, at (")) << words_of(flat.where);
  const Dip tilted = testing::dipped(bodies::tilted(box, 0.3), options);
  EXPECT_FALSE(testing::warns(tilted, WarningCode::AIR_TRAPPED));
  const Dip sphere = testing::dipped(sample::icosphere(20, 3), options);
  EXPECT_FALSE(testing::warns(sphere, WarningCode::AIR_TRAPPED));
}

TEST(Air, UnderTheCeilingOfACavityIsReportedOnce) {
  const Dip cup = dipped_cup(0, 0);
  EXPECT_TRUE(testing::warns(cup, WarningCode::AIR_TRAPPED));
  EXPECT_TRUE(warning_of_level_face(cup).code == WarningCode::CODE_UNSPECIFIED);
  EXPECT_TRUE(cup.figures.level_faces.empty());
}

TEST(Air, UnderALevelFaceAboveTheEndOfTheDipIsNotReported) {
  const mesh::Model table =
      bodies::blocks({-20, -17, 17, 20}, {-20, -17, 17, 20}, {0, 16, 20},
                     [](int i, int j, int k) { return k == 1 || (i != 1 && j != 1); });
  DipOptions options = testing::options_for("100x90", FilmModel::kStokes);
  EXPECT_NEAR(testing::dipped(table, options).figures.level_faces.at(0).immersion_mm, 16, 1e-6);
  options.depth_mm = 10;
  EXPECT_TRUE(testing::dipped(table, options).figures.level_faces.empty());
}

}  // namespace
}  // namespace hydroprint::pipeline
