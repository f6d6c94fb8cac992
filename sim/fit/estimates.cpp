#include "sim/fit/estimates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/number_text.h"

namespace hydroprint::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kTwoSided = 0.5 + 0.5 * kConfidence;

struct Interval {
  double low, high;
  bool is_one_sided;
};

/// Returns a confidence interval within the domain. If the estimate is at a bound, the interval is
/// one-sided and starts at the bound; its width is computed from the unconstrained estimate, if
/// that is in the domain.
Interval interval_of(double value, double unbounded, double error, double low, double high,
                     double degrees) {
  constexpr double kAt = 1e-9;
  const double one_sided = student_t(kConfidence, degrees) * error;
  if (value <= low + kAt) return {low, std::min(high, std::max(unbounded, low) + one_sided), true};
  if (value >= high - kAt) {
    return {std::max(low, std::min(unbounded, high) - one_sided), high, true};
  }
  const double half = student_t(kTwoSided, degrees) * error;
  return {std::max(low, value - half), std::min(high, value + half), false};
}

/// Returns the standard error in the units of the profile, to first order.
double natural_error(Parameter parameter, double scaled, double error,
                     const film::Profile& profile) {
  if (parameter != Parameter::kDrag) {
    return natural_value(parameter, error, profile) - natural_value(parameter, 0, profile);
  }
  // The length is proportional to scaled^(-1/2).
  const double length_mm = natural_value(parameter, scaled, profile);
  if (!std::isfinite(length_mm)) return std::numeric_limits<double>::quiet_NaN();
  return 0.5 * length_mm * error / scaled;
}

}  // namespace

std::vector<Estimate> estimates_of(const std::vector<Parameter>& free, const film::Profile& start,
                                   const VectorXd& u, const Domain& domain, const Linearised& at,
                                   double floor_mm, const VectorXd& discretisation) {
  const MatrixXd covariance = jackknife_covariance(at, floor_mm);
  const VectorXd unbounded = u - gain(at.jacobian) * at.residuals;
  const double degrees = degrees_of_freedom(at);
  std::vector<Estimate> out;
  for (Index j = 0; j < u.size(); ++j) {
    const Parameter parameter = free[j];
    const double error = std::hypot(std::sqrt(covariance(j, j)), discretisation[j]);
    const Interval interval =
        interval_of(u[j], unbounded[j], error, domain.low[j], domain.high[j], degrees);
    const auto natural = [&](double scaled) { return natural_value(parameter, scaled, start); };
    const auto [low, high] = std::minmax({natural(interval.low), natural(interval.high)});
    out.push_back({parameter, describe(parameter, start).name,
                   natural(scaled_value(parameter, start)), natural(u[j]),
                   natural_error(parameter, u[j], error, start), low, high, interval.is_one_sided,
                   u[j], error, discretisation[j]});
  }
  return out;
}

MatrixXd correlation_of(const MatrixXd& covariance) {
  const VectorXd inverse = covariance.diagonal().cwiseSqrt().cwiseInverse();
  return inverse.asDiagonal() * covariance * inverse.asDiagonal();
}

int degrees_of_freedom(const Linearised& known) {
  return static_cast<int>(std::max<Index>(1, known.jacobian.rows() - known.jacobian.cols()));
}

Undetermined explain(const Unknown& unknown, const std::vector<Parameter>& free,
                     const film::Profile& start, double residual_mm) {
  const Description what = describe(free[unknown.parameter], start);
  std::string reason;
  if (unknown.taken_for < 0) {
    reason = fmt::format(
        "changing the parameter over its plausible range ({}) moves the measured points by only "
        "{} mm, too little compared with residuals of {} mm. Measure more points where the film "
        "was stretched most",
        what.plausible, three_digits(unknown.moves_mm), three_digits(residual_mm));
  } else {
    reason = fmt::format(
        "these points cannot distinguish the parameter from {}: changing either of them moves the "
        "points in the same way, and the interval of the parameter would be wider than its "
        "plausible range ({}). Measure points spread farther over the film, or fit only one of "
        "the two parameters",
        describe(free[unknown.taken_for], start).name, what.plausible);
  }
  return {what.name, reason};
}

std::vector<Undetermined> never_determined() {
  const std::string boundary =
      "the velocity is prescribed along all edges of the film, so the parameter cancels out of the "
      "equations of the quasistatic sheet, and no landing point depends on it";
  return {
      {"young_modulus_mpa", boundary},
      {"density_kg_per_m3", boundary},
      {"thickness_mm", "landing points depend only on the ratio of ink_ratio_mm to thickness_mm"}};
}

}  // namespace hydroprint::fit
