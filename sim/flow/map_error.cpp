#include "sim/flow/map_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/check.h"
#include "sim/flow/back_path.h"

namespace hydroprint::flow {
namespace {

using Eigen::Vector2d;

/// Returns the indices of the waterlines that every_second() keeps, increasing.
std::vector<std::size_t> kept_waterlines(const DipField& dip) {
  HP_CHECK(dip.immersion_mm.size() == dip.fields.size());
  const std::vector<double>& at = dip.immersion_mm;
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < at.size(); ++k) {
    const bool has_neighbours = k > 0 && k + 1 < at.size() && kept.back() == k - 1;
    const bool is_left_out = has_neighbours && !restarts(at[k] - at[k - 1], at[k + 1] - at[k]) &&
                             !restarts(at[k + 1] - at[k], at[k] - at[k - 1]);
    if (!is_left_out) kept.push_back(k);
  }
  return kept;
}

DipField every_second(const DipField& dip) {
  DipField out{dip.outline, dip.depth_mm, {}, {}};
  for (const std::size_t k : kept_waterlines(dip)) {
    out.immersion_mm.push_back(dip.immersion_mm[k]);
    out.fields.push_back(dip.fields[k]);
  }
  return out;
}

/// The paths of some landings through a dip.
struct Paths {
  const DipField& dip;
  std::vector<BackPath> all;
  std::vector<std::size_t> order;

  Paths(const DipField& field, const std::vector<Landing>& landings, const Part& part)
      : dip(field), all(paths_to(field, landings, part)), order(neighbours_in_turn(all)) {}
  void follow_to(std::size_t k) { follow_back(dip, order, k, all); }
};

/// How two paths of each landing part.
class Parting {
 public:
  explicit Parting(std::size_t count) : difference_(count, Vector2d::Zero()), squares_(count, 0) {}

  /// Compares paths that have come to the same waterline.
  /// @param of_a  indices of the paths in `a`, one for each in `b`; empty: the same
  void compare(const Paths& a, const Paths& b, const std::vector<std::size_t>& of_a = {}) {
    latest_mm_.clear();
    for (std::size_t i = 0; i < squares_.size(); ++i) {
      const BackPath& path = a.all[of_a.empty() ? i : of_a[i]];
      const Vector2d difference = path.point_mm - b.all[i].point_mm;
      const double square = (difference - difference_[i]).squaredNorm();
      difference_[i] = difference;
      squares_[i] += square;
      if (square > 0) latest_mm_.push_back(std::sqrt(square));  // not if one is lost, or not begun
    }
  }
  /// Returns the sum over all comparisons of the squared distance by which two paths have parted.
  [[nodiscard]] double square_mm2(std::size_t i) const { return squares_[i]; }
  /// Returns a quantile of the distances by which paths have parted since the comparison before.
  [[nodiscard]] double latest_mm(double quantile) {
    if (latest_mm_.empty()) return 0;
    const auto at = latest_mm_.begin() + static_cast<std::ptrdiff_t>(
                                             quantile * static_cast<double>(latest_mm_.size() - 1));
    std::nth_element(latest_mm_.begin(), at, latest_mm_.end());
    return *at;
  }

 private:
  std::vector<Vector2d> difference_;
  std::vector<double> squares_, latest_mm_;
};

/// A dip, and the same dip with every second and every fourth of its waterlines.
struct Levels {
  const DipField& dip;
  DipField halved = every_second(dip), quartered = every_second(halved);
  std::vector<std::size_t> of_halved = kept_waterlines(dip), of_quartered = kept_waterlines(halved);
};

/// Returns the error of a path that parts by these squared distances from that through every second
/// waterline (`halved`), which parts by `quartered` from that through every fourth (README.md).
double error_mm(double halved_mm2, double quartered_mm2) {
  constexpr double kNoise_mm2 = 4e-8;
  constexpr double kMostGain = 7;  // of a third-order rule, as 2^3 - 1
  const double growth = std::sqrt((quartered_mm2 + kNoise_mm2) / (halved_mm2 + kNoise_mm2));
  const double gain = std::isnan(growth) ? 1 : std::clamp(growth - 1, 1.0, kMostGain);
  return std::sqrt(halved_mm2) / gain;
}

void trace(const Levels& levels, const std::vector<Landing>& landings,
           const std::vector<char>& is_judged, const Part& part, TracedBack& out) {
  Part judged;
  std::vector<std::size_t> at;  // of the judged landings in `part`
  for (std::size_t p = 0; p < part.size(); ++p) {
    if (is_judged[part[p]] == 0) continue;
    judged.push_back(part[p]);
    at.push_back(p);
  }
  Paths whole(levels.dip, landings, part), halved(levels.halved, landings, judged),
      quartered(levels.quartered, landings, judged);
  Parting first(judged.size()), second(judged.size());
  std::size_t i = levels.of_halved.size();
  for (std::size_t j = levels.of_quartered.size(); j-- > 0;) {
    while (i > levels.of_quartered[j]) {
      --i;
      whole.follow_to(levels.of_halved[i]);
      halved.follow_to(i);
      first.compare(whole, halved, at);
    }
    quartered.follow_to(j);
    second.compare(halved, quartered);
  }
  for (Paths* paths : {&whole, &halved, &quartered}) come_to_rest(paths->dip, paths->all);
  first.compare(whole, halved, at);
  second.compare(halved, quartered);
  for (std::size_t p = 0; p < part.size(); ++p) {
    out.film_mm[part[p]] = whole.all[p].point_mm;
    out.has_torn[part[p]] = whole.all[p].has_torn ? 1 : 0;
  }
  for (std::size_t k = 0; k < judged.size(); ++k)
    out.error_mm[judged[k]] = error_mm(first.square_mm2(k), second.square_mm2(k));
}

}  // namespace

Result<TracedBack> trace_back_with_error(const DipField& dip, const std::vector<Landing>& landings,
                                         const std::vector<char>& is_judged, std::string_view stage,
                                         const Context& context) {
  HP_CHECK(is_judged.size() == landings.size());
  const Levels levels{dip};
  TracedBack out;
  out.film_mm.resize(landings.size());
  out.has_torn.resize(landings.size(), 0);
  out.error_mm.resize(landings.size(), std::numeric_limits<double>::quiet_NaN());
  HP_RETURN_IF_ERROR(for_each_part(landings, stage, context, [&](const Part& part) {
    trace(levels, landings, is_judged, part, out);
  }));
  return out;
}

std::vector<double> depths_to_add(const DipField& dip, const std::vector<Landing>& landings,
                                  const Part& inexact, double limit_mm) {
  constexpr double kShare = 0.9;
  constexpr std::size_t kMost = 4000;
  Part part;
  for (std::size_t i = 0; i < inexact.size(); i += inexact.size() / kMost + 1)
    part.push_back(inexact[i]);
  const std::vector<std::size_t> kept = kept_waterlines(dip);
  const DipField halved_dip = every_second(dip);
  Paths whole(dip, landings, part), halved(halved_dip, landings, part);
  Parting parting(part.size());
  std::vector<double> out;
  for (std::size_t i = kept.size(); i-- > 0;) {
    whole.follow_to(kept[i]);
    halved.follow_to(i);
    parting.compare(whole, halved);
    if (!(parting.latest_mm(kShare) > limit_mm)) continue;
    const std::size_t end = i + 1 < kept.size() ? kept[i + 1] : kept[i];
    for (std::size_t k = kept[i]; k < end; ++k)
      out.push_back(0.5 * (dip.immersion_mm[k] + dip.immersion_mm[k + 1]));
  }
  std::ranges::sort(out);
  return out;
}

}  // namespace hydroprint::flow
