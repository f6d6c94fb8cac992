#include "sim/fit/least_squares.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace hydroprint::fit {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

Domain wide(Eigen::Index count) {
  return {VectorXd::Constant(count, -100), VectorXd::Constant(count, 100),
          VectorXd::Constant(count, 0.03)};
}

/// Ten points (exp(-a t) + b, a t / (1 + b^2)) of a curve, for u = (a, b).
VectorXd curved(const VectorXd& u) {
  VectorXd r(20);
  for (int i = 0; i < 10; ++i) {
    const double t = 0.2 * (i + 1);
    r[2 * i] = std::exp(-u[0] * t) + u[1];
    r[2 * i + 1] = u[0] * t / (1 + u[1] * u[1]);
  }
  return r;
}

Residuals curve_through(const VectorXd& truth) {
  return [wanted = curved(truth)](const VectorXd& u) -> Result<VectorXd> {
    return VectorXd(curved(u) - wanted);
  };
}

TEST(LeastSquares, FindsTheTrueParameters) {
  const Vector2d truth(0.8, 0.3);
  const auto found = minimise(curve_through(truth), Vector2d(0.1, 0), wide(2), 1e-4).value();
  EXPECT_TRUE(found.settled);
  EXPECT_LT((found.u - truth).norm(), 1e-3);
  EXPECT_LE(found.iterations, 6);
}

TEST(LeastSquares, StaysInTheDomainAndFindsItsBestPoint) {
  Domain domain = wide(2);
  domain.low[1] = 0.5;
  const auto residuals = curve_through(Vector2d(0.8, 0.3));
  const auto found = minimise(residuals, Vector2d(0.1, 1), domain, 1e-4).value();
  EXPECT_EQ(found.u[1], 0.5);
  // No neighbour along the bound may be better.
  const double least = mean_square(residuals(found.u).value());
  for (const double by : {-0.01, 0.01}) {
    EXPECT_GT(mean_square(residuals(found.u + Vector2d(by, 0)).value()), least);
  }
}

TEST(LeastSquares, PointsWithoutResidualsDoNotCount) {
  const Vector2d truth(0.8, 0.3);
  const auto all = curve_through(truth);
  const auto some = [&](const VectorXd& u) -> Result<VectorXd> {
    VectorXd r = all(u).value();
    r.segment<2>(4).setConstant(std::numeric_limits<double>::quiet_NaN());
    if (u[0] > 0.5) r.segment<2>(8).setConstant(std::numeric_limits<double>::quiet_NaN());
    return r;
  };
  const auto found = minimise(some, Vector2d(0.1, 0), wide(2), 1e-4).value();
  EXPECT_LT((found.u - truth).norm(), 1e-3);
  EXPECT_EQ(found.at.of_known().residuals.size(), 16);
}

TEST(LeastSquares, StepsAreThoseOfTheNormalEquations) {
  const MatrixXd jacobian = MatrixXd::Random(12, 3);
  const VectorXd residuals = VectorXd::Random(12);
  const VectorXd exact =
      -(jacobian.transpose() * jacobian).ldlt().solve(jacobian.transpose() * residuals);
  const VectorXd step = bounded_step({residuals, jacobian}, VectorXd::Zero(3), wide(3), 0, 100);
  EXPECT_LT((step - exact).norm(), 1e-10);
}

TEST(LeastSquares, ErrorsOfTheComputationAreReturned) {
  const Residuals failing = [](const VectorXd& /*u*/) -> Result<VectorXd> {
    return fail(Code::kCancelled, "cancelled");
  };
  const auto found = minimise(failing, Vector2d(0, 0), wide(2), 1e-4);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Code::kCancelled);
}

}  // namespace
}  // namespace hydroprint::fit
