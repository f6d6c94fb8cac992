// Accuracy of a dip at the default settings. tests/bench also compares with finer runs, which would
// take too long here.
#include <gtest/gtest.h>

#include "sim/pipeline/dip.h"
#include "sim/sample/icosphere.h"
#include "tests/support/exact_sphere.h"
#include "tests/support/sphere_dips.h"
#include "tests/support/two_threads.h"

namespace hydroprint::pipeline {
namespace {

using testing::Errors;
using testing::two_threads;

Dip dipped(const mesh::Model& model, const DipOptions& options) {
  return dip(model, options, two_threads()).value();
}

Errors apart(const Dip& a, const Dip& b) {
  return testing::errors_to(120, a.surface, validate::film_differences(a, b));
}

class Accuracy : public ::testing::TestWithParam<FilmModel> {};

TEST_P(Accuracy, OfACentredSphereIsAHundredthOfAMillimetre) {
  DipOptions options = testing::sphere_options("circle:105", 40, 120);
  options.film_model = GetParam();
  const Dip dip = dipped(sample::icosphere(40, 6), options);
  const Errors errors = testing::errors_to(
      120, dip.surface, testing::landing_distances_mm(dip, 40, [](double film_mm) {
        return exact::contact_angle_rad(40, 105, film_mm);
      }));
  EXPECT_GT(errors.summary.count, 25000U);
  EXPECT_EQ(errors.missing, 0U);
  EXPECT_LT(errors.summary.rms, 0.01);
  EXPECT_LT(errors.summary.max, 0.05);
}

TEST_P(Accuracy, OfAnOffCentreSphereIsTwoHundredthsOfAMillimetre) {
  const mesh::Model model = sample::icosphere(testing::kOffCentreRadius_mm, 6);
  DipOptions options = testing::off_centre_options(GetParam());
  const Dip usual = dipped(model, options);
  testing::scale_all(options, 0.6);
  const Errors errors = apart(usual, dipped(model, options));
  EXPECT_EQ(errors.missing, 0U);
  EXPECT_LT(errors.summary.rms, 0.02);
  EXPECT_LT(errors.summary.max, 0.1);
}

TEST_P(Accuracy, IsOfSecondOrderInMeshSize) {
  const auto found = testing::mesh_slope(sample::icosphere(testing::kOffCentreRadius_mm, 5),
                                         testing::off_centre_options(GetParam()), two_threads());
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_GT(found->slope, 1.8) << found->rms_mm_at_4 << ' ' << found->rms_mm_at_2 << ' '
                               << found->rms_mm_at_1;
}

INSTANTIATE_TEST_SUITE_P(Of, Accuracy, ::testing::Values(FilmModel::kStokes, FilmModel::kSheet),
                         [](const auto& model) {
                           return model.param == FilmModel::kStokes ? "Stokes" : "Sheet";
                         });

}  // namespace
}  // namespace hydroprint::pipeline
