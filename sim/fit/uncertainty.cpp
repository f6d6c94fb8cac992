#include "sim/fit/uncertainty.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace hydroprint::fit {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// If a parameter moves the points by less than this, rms, over its plausible range, its effect is
/// lost in the discretisation error.
constexpr double kLeastMove_mm = 0.02;
/// Variance of an entirely unknown value.
constexpr double kHuge = 1e12;
/// A point that alone determines a direction keeps at least this fraction of its residual.
constexpr double kLeastShare = 1e-3;

/// Information in the residuals about the parameters, split into independent directions.
struct Directions {
  MatrixXd known, unknown;  ///< orthonormal columns
  VectorXd inverse_square;  ///< inverse squares of the singular values of the known directions
};

Directions directions_of(const MatrixXd& jacobian) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(jacobian.transpose() * jacobian);
  const VectorXd& squares = eigen.eigenvalues();  // increasing
  const double points = 0.5 * static_cast<double>(jacobian.rows());
  const double least = kLeastMove_mm * kLeastMove_mm * points;
  const Index unknown = (squares.array() <= least).count();
  const Index known = squares.size() - unknown;
  return {eigen.eigenvectors().rightCols(known), eigen.eigenvectors().leftCols(unknown),
          squares.tail(known).cwiseInverse()};
}

MatrixXd inverse_normal(const Directions& d) {
  return d.known * d.inverse_square.asDiagonal() * d.known.transpose();
}

/// Returns the rms displacement of the points for a step of 1 in parameter j.
double moves_mm(const MatrixXd& jacobian, Index j) {
  const double points = 0.5 * static_cast<double>(std::max<Index>(jacobian.rows(), 1));
  return std::sqrt(jacobian.col(j).squaredNorm() / points);
}

Linearised with_only(const Linearised& all, Index parameter) {
  return {all.residuals, all.jacobian.col(parameter)};
}

double half_width(const MatrixXd& covariance, Index j, double t) {
  return t * std::sqrt(std::max(covariance(j, j), 0.0));
}

/// Returns the parameter whose estimate is most correlated with that of `parameter`.
Index partner(const MatrixXd& covariance, Index parameter) {
  Index best = -1;
  double most = 0;
  for (Index k = 0; k < covariance.cols(); ++k) {
    if (k == parameter) continue;
    const double square = covariance(parameter, k) * covariance(parameter, k) / covariance(k, k);
    if (square > most) {
      most = square;
      best = k;
    }
  }
  return best;
}

}  // namespace

MatrixXd gain(const MatrixXd& jacobian) {
  return inverse_normal(directions_of(jacobian)) * jacobian.transpose();
}

MatrixXd jackknife_covariance(const Linearised& known, double floor_mm) {
  const MatrixXd& jacobian = known.jacobian;
  const Directions directions = directions_of(jacobian);
  const MatrixXd inverse = inverse_normal(directions);
  MatrixXd scatter = MatrixXd::Zero(jacobian.cols(), jacobian.cols());
  for (Index i = 0; i + 1 < jacobian.rows(); i += 2) {
    const MatrixXd rows = jacobian.middleRows(i, 2);
    // Fraction of the point's own error that its residual shows; the fit absorbs the rest.
    const Matrix2d share = Matrix2d::Identity() - rows * inverse * rows.transpose();
    const Eigen::SelfAdjointEigenSolver<Matrix2d> eigen(share);
    const Eigen::Vector2d left = eigen.eigenvalues().cwiseMax(kLeastShare);
    const Eigen::Vector2d residual =
        eigen.eigenvectors() *
        (eigen.eigenvectors().transpose() * known.residuals.segment<2>(i)).cwiseQuotient(left);
    const VectorXd pull = rows.transpose() * residual;
    scatter += pull * pull.transpose();
  }
  return inverse * scatter * inverse + floor_mm * floor_mm * inverse +
         kHuge * directions.unknown * directions.unknown.transpose();
}

double student_t(double probability, double degrees) {
  return boost::math::quantile(boost::math::students_t_distribution<double>(degrees), probability);
}

std::vector<Unknown> unknowns(const Linearised& known, double floor_mm, double t) {
  const auto width_of = [&](const Linearised& part, Index j) {
    return half_width(jackknife_covariance(part, floor_mm), j, t);
  };
  std::vector<Unknown> out;
  for (Index j = 0; j < known.jacobian.cols(); ++j) {
    const double alone = width_of(with_only(known, j), 0);
    if (!(alone < 1)) out.push_back({j, moves_mm(known.jacobian, j), alone, -1});
  }
  if (!out.empty()) return out;
  const MatrixXd covariance = jackknife_covariance(known, floor_mm);
  Unknown worst;
  for (Index j = 0; j < covariance.cols(); ++j) {
    const double width = half_width(covariance, j, t);
    if (width < 1 || width <= worst.half_width) continue;
    worst = {j, moves_mm(known.jacobian, j), width, partner(covariance, j)};
  }
  if (worst.half_width > 0) out.push_back(worst);
  return out;
}

}  // namespace hydroprint::fit
