#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "sim/pipeline/figures.h"
#include "sim/pipeline/pipeline.h"
#include "sim/pipeline/simulate.h"
#include "sim/sample/icosphere.h"
#include "sim/sample/sample.h"
#include "tests/sim/pipeline/dips.h"
#include "tests/sim/support/bodies.h"
#include "tests/support/temporary_folder.h"

// For each warning, a body that provokes it and a similar one that does not.

namespace hydroprint::pipeline {
namespace {

namespace bodies = hydroprint::testing;

using testing::dipped;
using testing::warning_of;
using testing::warns;

DipOptions options_on(const std::string& film, FilmModel model = FilmModel::kStokes) {
  return testing::options_for(film, model);
}

/// A sphere of 20 mm radius, dipped to this contact angle in a much larger film.
DipOptions to_angle(double theta_deg, FilmModel model = FilmModel::kStokes) {
  DipOptions options = options_on("200x200", model);
  options.depth_mm = 20 * (1 - std::cos(theta_deg * std::numbers::pi / 180));
  return options;
}

TEST(Warnings, StretchBeyondStokesIsForStokesBeyondAStretchOfOnePointThree) {
  // The stretch along the meridian is 1 / cos(theta / 2): 1.3 at 79 degrees (field notes, section
  // 2).
  const mesh::Model sphere = sample::icosphere(20, 4);
  EXPECT_TRUE(warns(dipped(sphere, to_angle(95)), WarningCode::STRETCH_BEYOND_STOKES));
  EXPECT_FALSE(warns(dipped(sphere, to_angle(65)), WarningCode::STRETCH_BEYOND_STOKES));
  EXPECT_FALSE(
      warns(dipped(sphere, to_angle(95, FilmModel::kSheet)), WarningCode::STRETCH_BEYOND_STOKES));
}

TEST(Warnings, FilmTornIsForMoreThanTheProfilesStretch) {
  // The stretch 1 / cos(theta / 2) is 2 at 120 degrees.
  const mesh::Model sphere = sample::icosphere(20, 4);
  for (const FilmModel model : {FilmModel::kStokes, FilmModel::kSheet}) {
    DipOptions options = to_angle(120, model);
    EXPECT_FALSE(warns(dipped(sphere, options), WarningCode::FILM_TORN));
    options.profile.tear_stretch = 1.8;
    const Dip torn = dipped(sphere, options);
    EXPECT_TRUE(warns(torn, WarningCode::FILM_TORN));
    // In an infinite film, the stretch exceeds 1.8 beyond 112.5 degrees. The clamped edge makes
    // this angle slightly smaller.
    const double share = (std::cos(1.9635) - std::cos(2 * std::numbers::pi / 3)) / 2;
    EXPECT_GT(torn.figures.torn_share, 0.9 * share);
    EXPECT_LT(torn.figures.torn_share, 2 * share);
  }
}

TEST(Warnings, FilmWrinkledIsForLessThanTheProfilesStretch) {
  // The stretch around the sphere is cos(theta / 2): 0.6 at 106 degrees.
  const mesh::Model sphere = sample::icosphere(20, 4);
  for (const FilmModel model : {FilmModel::kStokes, FilmModel::kSheet}) {
    EXPECT_FALSE(warns(dipped(sphere, to_angle(95, model)), WarningCode::FILM_WRINKLED));
    EXPECT_TRUE(warns(dipped(sphere, to_angle(118, model)), WarningCode::FILM_WRINKLED));
  }
}

TEST(Warnings, FilmWrinkledComesWithAPicture) {
  const hydroprint::testing::TemporaryFolder folder;
  std::ostringstream obj;
  const mesh::Model sphere = sample::icosphere(20, 3);
  for (const Eigen::Vector3d& v : sphere.vertices) obj << "v " << v.transpose() << '\n';
  for (const Eigen::Vector3i& t : sphere.triangles) {
    obj << "f " << (t + Eigen::Vector3i::Ones()).transpose() << '\n';
  }
  SimulateOptions options;
  options.mesh = folder.write("sphere.obj", obj.str());
  options.needs_colour = false;
  options.dpi = 50;
  for (const double theta_deg : {95.0, 118.0}) {
    options.dip = to_angle(theta_deg);
    options.dip.map.tolerance_mm = 0.5;  // coarse pictures are enough
    options.dip.map.least_edge_mm = 1;
    const auto simulation = simulate(options, {});
    ASSERT_TRUE(simulation) << simulation.error().message;
    const auto& wrinkles = simulation->images->wrinkles;
    EXPECT_EQ(wrinkles.has_value(), theta_deg > 106);
    EXPECT_EQ(warns(simulation->dip, WarningCode::FILM_WRINKLED), wrinkles.has_value());
    if (!wrinkles) continue;
    EXPECT_EQ(wrinkles->width, simulation->images->stretch.width);
    EXPECT_NE(wrinkles->rgb, simulation->images->stretch.rgb);
  }
}

TEST(Warnings, ThetaClampedIsForFacesThatFaceUp) {
  // The cone has a level top. The spindle is pointed at both ends.
  EXPECT_TRUE(
      warns(dipped(bodies::cone(0.8, 12, 48), options_on("90x90")), WarningCode::THETA_CLAMPED));
  const mesh::Model spindle = bodies::turned({{0, 0}, {12, 12}, {0, 24}}, 48);
  EXPECT_FALSE(warns(dipped(spindle, options_on("90x90")), WarningCode::THETA_CLAMPED));
}

TEST(Warnings, PartsNotReachedIsForPartsThatStayDry) {
  const mesh::Model spindle = bodies::turned({{0, 0}, {24, 24}, {0, 48}}, 48);
  DipOptions options = options_on("150x150");
  EXPECT_FALSE(warns(dipped(spindle, options), WarningCode::PARTS_NOT_REACHED));
  options.depth_mm = 24;
  const Dip half = dipped(spindle, options);
  EXPECT_TRUE(warns(half, WarningCode::PARTS_NOT_REACHED));
  EXPECT_NEAR(half.figures.coverage, 0.5, 0.03);
}

TEST(Warnings, FilmEdgeReachedIsForObjectsWiderThanTheFilm) {
  const mesh::Model cone = bodies::cone(std::numbers::pi / 4, 20, 48);
  EXPECT_TRUE(warns(dipped(cone, options_on("30x80")), WarningCode::FILM_EDGE_REACHED));
  EXPECT_FALSE(warns(dipped(cone, options_on("60x80")), WarningCode::FILM_EDGE_REACHED));
}

TEST(Warnings, DragIgnoredIsForStokes) {
  const mesh::Model sphere = sample::icosphere(20, 3);
  DipOptions with_drag = to_angle(40);
  with_drag.profile.drag_length_mm = 30;
  EXPECT_TRUE(warns(dipped(sphere, with_drag), WarningCode::DRAG_IGNORED));
  EXPECT_FALSE(warns(dipped(sphere, to_angle(40)), WarningCode::DRAG_IGNORED));
  with_drag.film_model = FilmModel::kSheet;
  EXPECT_FALSE(warns(dipped(sphere, with_drag), WarningCode::DRAG_IGNORED));
}

TEST(Warnings, DipFastIsForSpeedsBeyondTheMeasuredOnes) {
  DipOptions options = to_angle(40);
  options.dip_speed_mm_per_s = 10;
  EXPECT_TRUE(warnings_of_profile(options).empty());
  options.dip_speed_mm_per_s = 10.5;
  ASSERT_EQ(warnings_of_profile(options).size(), 1U);
  EXPECT_EQ(warnings_of_profile(options)[0].code, WarningCode::DIP_FAST);
}

// Tested with numbers instead of a body: slits that are too narrow to mesh are closed beforehand,
// so hardly any body causes this warning.
TEST(Warnings, WaterlinesPassedOverAreCountedAndTheFirstIsNamed) {
  EXPECT_TRUE(warnings_of_motion(20, {}, 0).empty());
  const Warnings some = warnings_of_motion(18, {3.5, 7}, 0);
  ASSERT_EQ(some.size(), 1U);
  EXPECT_EQ(some[0].code, WarningCode::WATERLINES_PASSED_OVER);
  EXPECT_TRUE(some[0].message.starts_with("2 of 20 waterlines")) << some[0].message;
  EXPECT_TRUE(words_of(some[0].where).starts_with("3.5")) << words_of(some[0].where);
}

TEST(Warnings, WaterlinesLimitedNamesTheEffectsAndTheWorstPlace) {
  DipFigures figures;
  EXPECT_EQ(warnings_of_waterline(figures, DipOptions{}).size(), 0U);
  figures.coarse.widening = 1.5;
  figures.coarse.left_out_mm = {7, 8};
  figures.coarse.unresolved = {{20, 21}, {3, 3.5}};
  const Warnings some = warnings_of_waterline(figures, DipOptions{});
  ASSERT_EQ(some.size(), 1U);
  EXPECT_EQ(some.front().code, WarningCode::WATERLINES_LIMITED);
  EXPECT_EQ(words_of(some.front().where), "20.50 mm immersion");
  for (const char* part : {"800 waterlines", "1.5 times", "2 small level", "2 changes", "1 mm"}) {
    EXPECT_NE(some.front().message.find(part), std::string::npos) << part;
  }
}

TEST(Warnings, SheetUnsettledIsForFilmThatFolds) {
  // Film between two legs that join at the bottom is drawn towards both until it folds.
  const Result<mesh::Model> bend = sample::make_model("ubend");
  ASSERT_TRUE(bend) << bend.error().message;
  DipOptions options = options_on("A4", FilmModel::kSheet);
  EXPECT_TRUE(warns(dipped(*bend, options), WarningCode::SHEET_UNSETTLED));
  options.depth_mm = 20;
  EXPECT_FALSE(warns(dipped(*bend, options), WarningCode::SHEET_UNSETTLED));
}

// --- trapped film and air

/// Area of a regular polygon with 64 corners on a circle of this radius.
double round_area_mm2(double radius_mm) {
  return 32 * radius_mm * radius_mm * std::sin(std::numbers::pi / 32);
}

/// Whether there is a warning of air in a cavity, as opposed to air under a level face.
bool warns_of_cavity(const Dip& dip) {
  return std::any_of(dip.warnings.begin(), dip.warnings.end(), [](const Warning& w) {
    return w.code == WarningCode::AIR_TRAPPED && w.message.find("cm3 of air") != std::string::npos;
  });
}

TEST(Warnings, ARingTrapsFilmButNoAir) {
  const Dip ring = dipped(bodies::torus(24, 7, 64, 32), options_on("100x90"));
  EXPECT_TRUE(warns(ring, WarningCode::FILM_TRAPPED));
  EXPECT_FALSE(warns(ring, WarningCode::AIR_TRAPPED));
  ASSERT_EQ(ring.figures.traps.size(), 1U);
  const waterline::Trap& trap = ring.figures.traps[0];
  EXPECT_LT(trap.immersion_mm, 0.1);
  // The film is trapped within the inner edge of the facet on which the ring lies.
  const double area_mm2 = round_area_mm2(24 - 7 * std::sin(std::numbers::pi / 32));
  EXPECT_NEAR(trap.area_mm2, area_mm2, 0.01 * area_mm2);
  EXPECT_LT(trap.place_mm.norm(), 0.1);
  EXPECT_FALSE(trap.ceiling_mm);
}

TEST(Warnings, ARingWithAGapTrapsNothing) {
  const Dip open = dipped(bodies::blocks({-20, -12, 12, 20}, {-20, -12, 12, 20}, {0, 15},
                                         [](int i, int j, int) {
                                           const bool is_gap = i == 1 && j == 0;
                                           return !is_gap && !(i == 1 && j == 1);
                                         }),
                          options_on("100x90"));
  EXPECT_FALSE(warns(open, WarningCode::FILM_TRAPPED));
  EXPECT_FALSE(warns_of_cavity(open));
}

TEST(Warnings, ACupMouthDownTrapsFilmAndAir) {
  // The inner radius is 14 mm, and the ceiling is 20 mm above the mouth.
  const Dip down = dipped(bodies::cup(14, 18, 24, 4, false, 64), options_on("100x90"));
  EXPECT_TRUE(warns(down, WarningCode::FILM_TRAPPED));
  EXPECT_TRUE(warns_of_cavity(down));
  ASSERT_EQ(down.figures.traps.size(), 1U);
  const waterline::Trap& trap = down.figures.traps[0];
  EXPECT_NEAR(trap.area_mm2, round_area_mm2(14), 1);
  ASSERT_TRUE(trap.ceiling_mm);
  EXPECT_NEAR(*trap.ceiling_mm, 20, 0.05);
  EXPECT_NEAR(trap.air_mm3, 20 * round_area_mm2(14), 20);
  EXPECT_NE(warning_of(down, WarningCode::AIR_TRAPPED).message.find("12.3 cm3"), std::string::npos)
      << warning_of(down, WarningCode::AIR_TRAPPED).message;
  EXPECT_TRUE(
      std::holds_alternative<FilmPoint>(warning_of(down, WarningCode::AIR_TRAPPED).where.place));
}

TEST(Warnings, ACupMouthUpOrWithAVentTrapsNoAir) {
  const Dip up = dipped(bodies::cup(14, 18, 24, 4, true, 64), options_on("100x90"));
  EXPECT_FALSE(warns(up, WarningCode::FILM_TRAPPED));
  EXPECT_FALSE(warns_of_cavity(up));
  // A square cup with its mouth down and a hole in its bottom.
  const Dip vented =
      dipped(bodies::blocks({-18, -14, -3, 3, 14, 18}, {-18, -14, -3, 3, 14, 18}, {0, 20, 24},
                            [](int i, int j, int k) {
                              const bool is_wall = i == 0 || i == 4 || j == 0 || j == 4;
                              return is_wall || (k == 1 && !(i == 2 && j == 2));
                            }),
             options_on("100x90"));
  EXPECT_TRUE(warns(vented, WarningCode::FILM_TRAPPED));
  EXPECT_FALSE(warns_of_cavity(vented));
}

TEST(Warnings, AirIsTrappedEvenIfTheDipEndsBelowTheCeiling) {
  DipOptions options = options_on("100x90");
  options.depth_mm = 6;
  const Dip cup = dipped(bodies::cup(14, 18, 24, 4, false, 64), options);
  EXPECT_TRUE(warns_of_cavity(cup));
  const Dip ring = dipped(bodies::torus(24, 7, 64, 32), options);
  EXPECT_TRUE(warns(ring, WarningCode::FILM_TRAPPED));
  EXPECT_FALSE(warns(ring, WarningCode::AIR_TRAPPED));
}

TEST(Warnings, ACavityThatClosesAboveTheRimIsReportedByItsImmersion) {
  // Four legs of 10 mm under a square cup with its mouth down: the waterline closes at the rim.
  const Dip legs = dipped(bodies::blocks({-20, -14, 14, 20}, {-20, -14, 14, 20}, {0, 10, 16, 20},
                                         [](int i, int j, int k) {
                                           const bool is_leg = i != 1 && j != 1;
                                           const bool is_wall = i != 1 || j != 1;
                                           return k == 0 ? is_leg : k == 2 || is_wall;
                                         }),
                          options_on("100x90"));
  EXPECT_TRUE(warns_of_cavity(legs));
  ASSERT_FALSE(legs.figures.traps.empty());
  EXPECT_NEAR(legs.figures.traps[0].immersion_mm, 10, 0.05);
  EXPECT_NEAR(legs.figures.traps[0].air_mm3, 28 * 28 * 6, 0.02 * 28 * 28 * 6);
  // The same body without the rim is a table: air can escape from under its top.
  const Dip table =
      dipped(bodies::blocks({-20, -14, 14, 20}, {-20, -14, 14, 20}, {0, 16, 20},
                            [](int i, int j, int k) { return k == 1 || (i != 1 && j != 1); }),
             options_on("100x90"));
  EXPECT_FALSE(warns(table, WarningCode::FILM_TRAPPED));
  EXPECT_FALSE(warns_of_cavity(table));
}

TEST(Warnings, AClosedCavityIsNotATrap) {
  // The cavity is inside the solid, so neither film nor water reaches it.
  const Dip hollow =
      dipped(bodies::together({bodies::box({-15, -15, 0}, {15, 15, 20}),
                               bodies::inside_out(bodies::box({-8, -8, 5}, {8, 8, 15}))}),
             options_on("100x90"));
  EXPECT_FALSE(warns(hollow, WarningCode::FILM_TRAPPED));
  EXPECT_FALSE(warns_of_cavity(hollow));
}

}  // namespace
}  // namespace hydroprint::pipeline
