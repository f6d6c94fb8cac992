#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/pipeline/dip.h"
#include "sim/pipeline/figures.h"
#include "sim/sample/icosphere.h"
#include "tests/sim/pipeline/dips.h"
#include "tests/sim/support/bodies.h"
#include "tests/support/exact_sphere.h"
#include "tests/support/sphere_dips.h"

// The stated error of the map, and its tolerance.

namespace hydroprint::pipeline {
namespace {

namespace bodies = hydroprint::testing;

class StatedError : public ::testing::TestWithParam<FilmModel> {};

TEST_P(StatedError, CoversTheTrueOneOfASphere) {
  constexpr double kSphere_mm = 40, kVat_mm = 105;
  DipOptions options = hydroprint::testing::sphere_options("circle:105", kSphere_mm, 120);
  options.film_model = GetParam();
  const Dip dip = testing::dipped(sample::icosphere(kSphere_mm, 5), options);
  std::vector<double> stated_mm, true_mm;
  int covered = 0;
  for (std::size_t v = 0; v < dip.surface.points.size(); ++v) {
    const double cosine = -dip.surface.points[v].z() / kSphere_mm;
    const double film_mm = dip.map.surface.film_mm[v].norm();
    if (std::isnan(film_mm) || cosine < -0.5) continue;
    const double exact_mm =
        exact::film_radius_mm(kSphere_mm, kVat_mm, std::acos(std::clamp(cosine, -1.0, 1.0)));
    stated_mm.push_back(dip.map.surface.error_mm[v]);
    true_mm.push_back(std::abs(film_mm - exact_mm));
    if (true_mm.back() <= stated_mm.back()) ++covered;
  }
  ASSERT_GT(stated_mm.size(), 5000U);
  EXPECT_GE(covered, 0.9 * static_cast<double>(stated_mm.size()));
  std::ranges::sort(stated_mm);
  std::ranges::sort(true_mm);
  EXPECT_LT(stated_mm[stated_mm.size() / 2], 12 * true_mm[true_mm.size() / 2]);
}

INSTANTIATE_TEST_SUITE_P(Of, StatedError, ::testing::Values(FilmModel::kStokes, FilmModel::kSheet),
                         [](const auto& model) {
                           return model.param == FilmModel::kStokes ? "Stokes" : "Sheet";
                         });

TEST(StatedErrorOfADip, IsFiniteOrInfiniteWhereFilmArrivesAndNaNElsewhere) {
  const Dip dip = testing::dipped(bodies::tilted(bodies::box({-15, -10, 0}, {15, 10, 20}), 0.4),
                                  testing::options_for("100x90", FilmModel::kStokes));
  const flow::SurfaceMap& map = dip.map.surface;
  ASSERT_EQ(map.error_mm.size(), map.film_mm.size());
  for (std::size_t v = 0; v < map.film_mm.size(); ++v) {
    EXPECT_EQ(std::isnan(map.error_mm[v]), std::isnan(map.film_mm[v].x()));
    EXPECT_FALSE(map.error_mm[v] <= 0);
  }
  ASSERT_TRUE(dip.figures.error);
  EXPECT_LE(dip.figures.error->p50_mm, dip.figures.error->p95_mm);
}

TEST(Tolerance, AddsWaterlinesOnlyWhereTheStatedErrorExceedsIt) {
  const mesh::Model tilted = bodies::tilted(bodies::box({-15, -10, 0}, {15, 10, 20}), 0.4);
  DipOptions options = testing::options_for("100x90", FilmModel::kStokes);
  const Dip usual = testing::dipped(tilted, options);
  options.tolerance_mm = 1e3;
  EXPECT_EQ(testing::dipped(tilted, options).figures.steps, usual.figures.steps);
  options.tolerance_mm = 0.02;
  const Dip finer = testing::dipped(tilted, options);
  EXPECT_GT(finer.figures.steps, usual.figures.steps);
  EXPECT_LT(finer.figures.error->p95_mm, usual.figures.error->p95_mm);
  // Film that tears at the box's edges is not known to 0.02 mm with any number of waterlines.
  EXPECT_GT(finer.figures.error->beyond_share, 0);
  EXPECT_TRUE(testing::warns(finer, WarningCode::TOLERANCE_EXCEEDED));
  EXPECT_FALSE(testing::warns(usual, WarningCode::TOLERANCE_EXCEEDED));
}

}  // namespace
}  // namespace hydroprint::pipeline
