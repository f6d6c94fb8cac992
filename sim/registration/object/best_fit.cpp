#include "sim/registration/object/best_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hydroprint::registration {
namespace {

constexpr double kMismatchTolerance = 0.03;
constexpr double kSigmas = 3;
/// Smaller differences of the misfit do not decide. Without noise, all misfits are nearly zero.
constexpr double kSameMisfit_mm = 0.01;
constexpr double kNever = std::numeric_limits<double>::infinity();

bool equals_within_noise(const FitQuality& fit, const FitQuality& best) {
  const double share = best.points / std::max(1.0, best.given);
  const double points_sigma = std::sqrt(best.given * share * (1 - share));
  const double misfit_sigma = best.misfit_mm / std::sqrt(2 * std::max(1.0, best.misfit_blocks));
  return fit.points >= best.points - kSigmas * points_sigma - 1 &&
         fit.misfit_mm <= best.misfit_mm + kSigmas * misfit_sigma + kSameMisfit_mm;
}

/// Returns the index of the fit for which `value` is smallest.
template <class Value>
std::size_t least(std::span<const FitQuality> fits, const Value& value) {
  const auto found = std::min_element(
      fits.begin(), fits.end(), [&](const auto& a, const auto& b) { return value(a) < value(b); });
  return static_cast<std::size_t>(found - fits.begin());
}

}  // namespace

std::size_t best_fit(std::span<const FitQuality> fits) {
  const double mismatch =
      fits[least(fits, [](const FitQuality& fit) { return fit.mismatch; })].mismatch;
  const auto is_near = [&](const FitQuality& fit) {
    return fit.mismatch <= mismatch + kMismatchTolerance;
  };
  const FitQuality& best = fits[least(
      fits, [&](const FitQuality& fit) { return is_near(fit) ? fit.distance_mm : kNever; })];
  return least(fits, [&](const FitQuality& fit) {
    return is_near(fit) && equals_within_noise(fit, best) ? fit.turn_rad : kNever;
  });
}

}  // namespace hydroprint::registration
