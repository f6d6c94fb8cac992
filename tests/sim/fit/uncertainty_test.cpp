// Coverage of the intervals, tested with linearised fits of random noise, in which only the
// statistics matter.
#include "sim/fit/uncertainty.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <random>

#include "sim/fit/estimates.h"

namespace hydroprint::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr int kDraws = 1000;

/// A Jacobian as of a real print: ink moves few points, drag moves distant points, and swelling
/// moves all points.
MatrixXd jacobian_of(int points) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-60, 60);
  MatrixXd jacobian(2 * points, 4);
  for (int i = 0; i < points; ++i) {
    const Vector2d p(place(random), place(random));
    const double r = p.norm() / 60;
    jacobian.block<2, 1>(2 * i, 0) = p.x() > 20 ? Vector2d(2, 0.3) : Vector2d(0.1, 0);
    jacobian.block<2, 1>(2 * i, 1) = -r * r * p / 10;
    jacobian.block<2, 1>(2 * i, 2) = Vector2d(-0.3 * p.x(), 0.02 * p.y());
    jacobian.block<2, 1>(2 * i, 3) = Vector2d(0.02 * p.x(), -0.3 * p.y());
  }
  return jacobian;
}

/// Statistics of many fits, by parameter: rms of the errors divided by their standard errors, and
/// the share of the 95 % intervals that contain the true value.
struct Coverage {
  VectorXd normalised_rms, held;
};

Coverage cover(const MatrixXd& jacobian,
               const std::function<Vector2d(int, double, double)>& noise) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  const auto points = static_cast<int>(jacobian.rows() / 2);
  const double t = student_t(0.975, static_cast<double>(jacobian.rows() - jacobian.cols()));
  Coverage out{VectorXd::Zero(jacobian.cols()), VectorXd::Zero(jacobian.cols())};
  for (int draw = 0; draw < kDraws; ++draw) {
    VectorXd r(jacobian.rows());
    for (int i = 0; i < points; ++i) {
      const double x = normal(random);
      r.segment<2>(2 * i) = noise(i, x, normal(random));
    }
    const VectorXd error = -gain(jacobian) * r;
    const VectorXd left = r + jacobian * error;
    const VectorXd standard = jackknife_covariance({left, jacobian}, 0).diagonal().cwiseSqrt();
    for (Index j = 0; j < error.size(); ++j) {
      out.normalised_rms[j] += std::pow(error[j] / standard[j], 2) / kDraws;
      if (std::abs(error[j]) < t * standard[j]) out.held[j] += 1.0 / kDraws;
    }
  }
  out.normalised_rms = out.normalised_rms.cwiseSqrt();
  return out;
}

void expect_honest(const Coverage& coverage) {
  for (Index j = 0; j < coverage.held.size(); ++j) {
    EXPECT_NEAR(coverage.normalised_rms[j], 1, 0.15) << j;
    EXPECT_NEAR(coverage.held[j], 0.95, 0.025) << j;
  }
}

TEST(Uncertainty, CoversEqualErrors) {
  expect_honest(cover(jacobian_of(80), [](int, double x, double y) -> Vector2d {
    return {0.1 * x, 0.1 * y};
  }));
}

TEST(Uncertainty, CoversUnequalCorrelatedErrors) {
  // Where film is compressed, errors are larger and correlated; here at the distant points.
  const MatrixXd jacobian = jacobian_of(150);
  expect_honest(cover(jacobian, [&](int i, double x, double y) -> Vector2d {
    const bool is_far = jacobian.block<2, 1>(2 * i, 1).norm() > 3;
    return is_far ? Vector2d(0.3 * x, 0.25 * x + 0.1 * y) : Vector2d(0.05 * x, 0.05 * y);
  }));
}

TEST(Uncertainty, OfEqualErrorsMatchesTheTextbook) {
  const MatrixXd jacobian = jacobian_of(2000);
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, 0.1);
  const VectorXd r = VectorXd::NullaryExpr(jacobian.rows(), [&] { return normal(random); });
  const VectorXd left = r - jacobian * (gain(jacobian) * r);
  const MatrixXd textbook = 0.01 * (jacobian.transpose() * jacobian).inverse();
  const MatrixXd ours = jackknife_covariance({left, jacobian}, 0);
  for (Index j = 0; j < 4; ++j) EXPECT_NEAR(std::sqrt(ours(j, j) / textbook(j, j)), 1, 0.1) << j;
}

TEST(Uncertainty, QuantilesMatchTheTables) {
  EXPECT_NEAR(student_t(0.975, 5), 2.5706, 1e-4);
  EXPECT_NEAR(student_t(0.95, 30), 1.6973, 1e-4);
  EXPECT_NEAR(student_t(0.975, 1e6), 1.95997, 1e-4);
}

VectorXd noise(Index rows, double sigma) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal(0, sigma);
  return VectorXd::NullaryExpr(rows, [&] { return normal(random); });
}

TEST(Unknowns, AreEmptyIfAllIsKnown) {
  const MatrixXd jacobian = jacobian_of(80);
  EXPECT_TRUE(unknowns({noise(160, 0.1), jacobian}, 0.003, 2).empty());
}

TEST(Unknowns, IncludeParametersThatMoveNothing) {
  MatrixXd jacobian = jacobian_of(80);
  jacobian.col(1) *= 1e-4;
  for (const double sigma : {0.1, 0.0}) {  // with and without noise
    const auto found = unknowns({noise(160, sigma), jacobian}, 0.003, 2);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].parameter, 1);
    EXPECT_EQ(found[0].taken_for, -1);
    EXPECT_LT(found[0].moves_mm, 0.01);
  }
}

TEST(Unknowns, IncludeParametersLostInTheNoise) {
  const MatrixXd jacobian = jacobian_of(80);
  const auto found = unknowns({noise(160, 8), jacobian}, 0.003, 2);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].parameter, 0) << "ink moves the points least, so its parameter is lost first";
}

TEST(Unknowns, OneOfTwoEquivalentParametersIsNamedWithTheOther) {
  MatrixXd jacobian = jacobian_of(80);
  jacobian.col(1) = 0.5 * jacobian.col(2) + 1e-5 * jacobian.col(1);
  for (const double sigma : {0.1, 0.0}) {
    const auto found = unknowns({noise(160, sigma), jacobian}, 0.003, 2);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].parameter, 1)
        << "the parameter that moves the points half as far is the less known one";
    EXPECT_EQ(found[0].taken_for, 2);
  }
}

// ---- Intervals ----------------------------------------------------------------------------------

std::vector<Estimate> estimates(double drag, double unbounded_by) {
  const MatrixXd jacobian = jacobian_of(80);
  const std::vector<Parameter> free(kAllParameters.begin(), kAllParameters.end());
  VectorXd u = VectorXd::Constant(4, 0.2);
  u[1] = drag;
  const Domain domain{VectorXd::Zero(4), VectorXd::Constant(4, 3), VectorXd::Constant(4, 0.01)};
  VectorXd residuals = noise(160, 0.1);
  residuals -= jacobian * (gain(jacobian) * residuals);
  residuals -= unbounded_by * jacobian.col(1);
  return estimates_of(free, {}, u, domain, {residuals, jacobian}, 0.003, VectorXd::Zero(4));
}

TEST(Estimates, LieInTheMiddleOfTheirScaledIntervals) {
  const auto all = estimates(0.2, 0);
  ASSERT_EQ(all.size(), 4u);
  const double t = student_t(0.975, 156);
  EXPECT_EQ(all[0].name, "ink_ratio_mm");
  EXPECT_NEAR(all[0].value, 0.1, 1e-12)
      << "the scaled value is a fifth, and the film is 0.5 mm thick";
  EXPECT_NEAR(all[0].high - all[0].value, t * all[0].standard_error, 1e-9);
  EXPECT_NEAR(all[0].value - all[0].low, t * all[0].standard_error, 1e-9);
  EXPECT_NEAR(all[2].value, 1.06, 1e-12);
  // Drag is fitted as 1 / length^2, so the ends of its interval are swapped and its value is not in
  // the middle.
  EXPECT_NEAR(1 / std::pow(all[1].low, 2) - 0.002, 0.002 - 1 / std::pow(all[1].high, 2), 1e-9);
  EXPECT_NEAR(all[1].value, std::sqrt(500), 1e-9);
  EXPECT_FALSE(all[1].is_one_sided);
}

TEST(Estimates, AtABoundHaveAOneSidedInterval) {
  const auto at_bound = estimates(0, -0.05);
  EXPECT_TRUE(at_bound[1].is_one_sided);
  EXPECT_TRUE(std::isinf(at_bound[1].value));
  EXPECT_TRUE(std::isinf(at_bound[1].high));
  EXPECT_TRUE(std::isnan(at_bound[1].standard_error));
  EXPECT_NEAR(0.01 * student_t(0.95, 156) * at_bound[1].scaled_error,
              1 / std::pow(at_bound[1].low, 2), 1e-9);
  EXPECT_FALSE(at_bound[0].is_one_sided);
}

TEST(Estimates, IncludeTheComputationsOwnError) {
  const MatrixXd jacobian = jacobian_of(80);
  const Domain domain{VectorXd::Zero(4), VectorXd::Constant(4, 3), VectorXd::Constant(4, 0.01)};
  const VectorXd u = VectorXd::Constant(4, 0.2);
  const auto all = estimates_of({kAllParameters.begin(), kAllParameters.end()}, {}, u, domain,
                                {noise(160, 0.1), jacobian}, 0.003, VectorXd::Constant(4, 0.1));
  for (const Estimate& e : all) EXPECT_GT(e.scaled_error, 0.1);
}

}  // namespace
}  // namespace hydroprint::fit
