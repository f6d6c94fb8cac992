#include "sim/sheet/inertial_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/sample/icosphere.h"
#include "sim/sheet/sheet_flow.h"
#include "tests/sim/support/bodies.h"
#include "tests/sim/support/dips.h"

namespace hydroprint::sheet {
namespace {

using Eigen::Vector2d;

constexpr double kRadius_mm = 20;
constexpr double kDipSpeed_mm_per_s = 5;

/// The Stokes dip of a sphere off the middle of its film, to theta = 100 degrees.
flow::DipField stokes() {
  hydroprint::testing::DipSetting setting;
  setting.film = hydroprint::testing::film_of("100x80");
  setting.depth_mm = kRadius_mm * (1 - std::cos(100 * 3.14159265358979 / 180));
  setting.coarsen(1.5);
  return hydroprint::testing::solve_dip(
             hydroprint::testing::moved(sample::icosphere(kRadius_mm, 4), {-12, 5, 0}), setting)
      .field;
}

/// Thickness of the film at rest, with a thick band next to the sphere.
double rest_thickness(const std::array<Vector2d, 3>& rest_mm) {
  const double x = (rest_mm[0] + rest_mm[1] + rest_mm[2]).x() / 3;
  return 0.5 + 0.2 / (1 + std::pow((x - 15) / 6, 4));
}

InertialOptions inertial_options(double step_s) {
  InertialOptions options;
  options.elasticity = {1.82, 0.5};
  options.density_kg_per_m3 = 1300;
  options.dip_speed_mm_per_s = kDipSpeed_mm_per_s;
  options.step_mm = kDipSpeed_mm_per_s * step_s;
  options.tolerance_mm = 1e-5;
  options.most_passes = 10;
  return options;
}

flow::DipField with_inertia(const flow::DipField& first, const InertialOptions& options) {
  auto result = inertial_flow(first, rest_thickness, options, {});
  EXPECT_TRUE(result) << result.error().message;
  return result ? std::move(*result) : first;
}

flow::DipField quasistatic(const flow::DipField& first) {
  return sheet_flow(first, rest_thickness, {0, 1e-5, 20}, {}).value().field;
}

/// Largest distance between the rest positions of film nodes at the last waterline, in two dips.
double apart_mm(const flow::DipField& a, const flow::DipField& b) {
  const std::size_t last = a.fields.size() - 1;
  const auto rest_a = flow::trace_back(a, last), rest_b = flow::trace_back(b, last);
  double most = 0;
  for (std::size_t n = 0; n < rest_a.size(); ++n) {
    most = std::max(most, (rest_a[n] - rest_b[n]).norm());
  }
  return most;
}

/// Largest speed at a waterline, per unit of dip speed.
double largest(const velocity::VelocityField& field) {
  double most = 0;
  for (const Vector2d& u : field.nodes()) most = std::max(most, u.norm());
  return most;
}

TEST(InertialFlow, ConvergesToTheQuasistaticSheetLinearlyInItsStep) {
  const flow::DipField first = stokes();
  const flow::DipField slow = quasistatic(first);
  // A step displaces film by the share g dt of the sphere's radius, with g = u / R. The relative
  // error of its velocity is less than half that share (a quarter in
  // SheetStep.ConvergesToTheQuasistaticSheet...). The error of the film's position is the sum of
  // the velocity errors over the dip.
  double bound_mm_per_s = 0;
  for (std::size_t k = 1; k < first.fields.size(); ++k) {
    const double u = largest(first.fields[k]);
    bound_mm_per_s += 0.5 * (first.immersion_mm[k] - first.immersion_mm[k - 1]) * u *
                      (kDipSpeed_mm_per_s * u / kRadius_mm);
  }
  const flow::DipField of_20_ms = with_inertia(first, inertial_options(0.02));
  const flow::DipField of_10_ms = with_inertia(first, inertial_options(0.01));
  const flow::DipField of_5_ms = with_inertia(first, inertial_options(0.005));
  const double at_20_ms = apart_mm(of_20_ms, slow);
  EXPECT_LT(at_20_ms, 0.02 * bound_mm_per_s);
  // Halving the step halves its effect. The error at the default step is tested below.
  EXPECT_NEAR(std::log2(apart_mm(of_20_ms, of_10_ms) / apart_mm(of_10_ms, of_5_ms)), 1, 0.1);
  const double by_default = InertialOptions().step_mm / kDipSpeed_mm_per_s;
  EXPECT_LT(apart_mm(with_inertia(first, inertial_options(by_default)), slow), 0.0025);
  // The thickness matters, so the two results do not agree merely because both equal Stokes flow.
  EXPECT_GT(apart_mm(first, slow), 20 * at_20_ms);
}

TEST(InertialFlow, ChangesWithPoissonsRatioButHardlyWithYoungsModulusOrDensity) {
  const flow::DipField first = stokes();
  const auto with = [&](double young, double density, double poisson) {
    InertialOptions options = inertial_options(0.02);
    options.elasticity = {young, poisson};
    options.density_kg_per_m3 = density;
    return with_inertia(first, options);
  };
  const flow::DipField paper = with(1.82, 1300, 0.5);
  EXPECT_LT(apart_mm(paper, with(18.2, 1300, 0.5)), 1e-3);
  EXPECT_LT(apart_mm(paper, with(1.82, 2600, 0.5)), 1e-3);
  EXPECT_GT(apart_mm(paper, with(1.82, 1300, 0.3)), 0.05);
}

}  // namespace
}  // namespace hydroprint::sheet
