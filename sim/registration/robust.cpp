#include "sim/registration/robust.h"

#include <algorithm>
#include <cmath>

namespace hydroprint::registration {
namespace {

constexpr double kTukey = 4.685;
constexpr double kMadToSigma = 1.4826;

}  // namespace

double spread_of(std::vector<double> sigmas_off) {
  if (sigmas_off.empty()) return 1;
  for (double& x : sigmas_off) x = std::abs(x);
  const auto middle = sigmas_off.begin() + static_cast<std::ptrdiff_t>(sigmas_off.size() / 2);
  std::nth_element(sigmas_off.begin(), middle, sigmas_off.end());
  return std::max(1.0, kMadToSigma * *middle);
}

double robust_weight(double sigmas_off, double spread) {
  const double u = sigmas_off / (kTukey * spread);
  return std::abs(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;
}

}  // namespace hydroprint::registration
