#include "sim/velocity/curve_sampling.h"

#include <algorithm>
#include <cmath>

#include "sim/base/check.h"

namespace hydroprint::velocity {
namespace {

double distance_to_chord(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                         const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (a + t * along - p).norm();
}

/// Divides the curve's long edges, so that samples can lie on them.
std::vector<Eigen::Vector2d> divide(const std::vector<Eigen::Vector2d>& curve, double spacing_mm) {
  std::vector<Eigen::Vector2d> fine;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Eigen::Vector2d& a = curve[i];
    const Eigen::Vector2d& b = curve[(i + 1) % curve.size()];
    const int pieces = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing_mm - 1e-9)));
    for (int k = 0; k < pieces; ++k) fine.emplace_back(a + (b - a) * k / pieces);
  }
  return fine;
}

bool strays(const std::vector<Eigen::Vector2d>& fine, std::size_t from, std::size_t to,
            double tolerance_mm) {
  const Eigen::Vector2d& a = fine[from];
  const Eigen::Vector2d& b = fine[to % fine.size()];
  for (std::size_t i = from + 1; i < to; ++i) {
    if (distance_to_chord(fine[i], a, b) > tolerance_mm) return true;
  }
  return false;
}

/// Returns the corner at which the curve turns most sharply. Sampling starts there, so that a
/// single corner is never cut off.
std::size_t sharpest(const std::vector<Eigen::Vector2d>& curve) {
  std::size_t best = 0;
  double least = 2;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Eigen::Vector2d in = curve[i] - curve[(i + curve.size() - 1) % curve.size()];
    const Eigen::Vector2d out = curve[(i + 1) % curve.size()] - curve[i];
    const double cosine = in.dot(out) / std::max(in.norm() * out.norm(), 1e-300);
    if (cosine < least - 1e-9) {
      least = cosine;
      best = i;
    }
  }
  return best;
}

}  // namespace

std::vector<Eigen::Vector2d> sample_loop(const std::vector<Eigen::Vector2d>& curve,
                                         double spacing_mm, double tolerance_mm, double least_mm) {
  HP_CHECK(!curve.empty());
  HP_CHECK(spacing_mm > 0);
  std::vector<Eigen::Vector2d> fine = divide(curve, spacing_mm);
  std::rotate(fine.begin(), fine.begin() + static_cast<std::ptrdiff_t>(sharpest(fine)), fine.end());
  std::vector<Eigen::Vector2d> picked;
  const std::size_t count = fine.size();
  for (std::size_t from = 0; from < count;) {
    picked.push_back(fine[from]);
    std::size_t to = from + 1;
    double length_mm = (fine[to % count] - fine[from]).norm();
    while (to < count) {
      const double more = (fine[(to + 1) % count] - fine[to]).norm();
      const bool tiny = length_mm < least_mm;
      if (!tiny &&
          (length_mm + more > spacing_mm * 1.0001 || strays(fine, from, to + 1, tolerance_mm))) {
        break;
      }
      length_mm += more;
      ++to;
    }
    from = to;
  }
  return picked;
}

}  // namespace hydroprint::velocity
