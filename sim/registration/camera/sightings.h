#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "sim/registration/pairs.h"
#include "sim/scan/lens.h"

namespace hydroprint::registration {

/// A point on the board in one view, for the current estimate of lens and pose.
struct Sighting {
  std::size_t view;
  Pair pair;
  double robust = 1;  ///< robust weight

  [[nodiscard]] double weight() const { return robust / std::pow(pair.own_sigma_mm(), 2); }
};

/// Estimate of a patch's constant noise from its sightings, in units of its standard deviation:
/// pull / square, positive outward, with variance 1 / square.
struct Constant {
  double square = 1, pull = 0;

  /// @param sign  -1 removes a sighting again
  void add(const Sighting& s, double sign = 1) {
    const double by_constant = sign * s.weight() * s.pair.constant_sigma_mm;
    square += by_constant * s.pair.constant_sigma_mm;
    pull += by_constant * s.pair.residual_mm;
  }
};

[[nodiscard]] inline Constant constant_of(std::span<const Sighting> patch) {
  Constant out;
  for (const Sighting& s : patch) out.add(s);
  return out;
}

/// Calls `use` for each patch, with all sightings of the patch.
/// @param sightings  sorted by patch
template <class Use>
void for_each_patch(const std::vector<Sighting>& sightings, Use use) {
  for (auto first = sightings.begin(); first != sightings.end();) {
    const auto is_other = [&](const Sighting& s) {
      return s.pair.scan->patch != first->pair.scan->patch;
    };
    const auto last = std::find_if(first, sightings.end(), is_other);
    use(std::span(first, last));
    first = last;
  }
}

/// Derivative of a sighting's residual with respect to the lens parameters, in units of their prior
/// standard deviations, and with respect to the pose of its view.
using SightingRow = Eigen::Matrix<double, scan::Lens::kParameters + 6, 1>;

/// Returns the index of a view's pose among all unknowns; the lens comes first.
[[nodiscard]] inline Eigen::Index place_of(std::size_t view) {
  return scan::Lens::kParameters + 6 * static_cast<Eigen::Index>(view);
}

/// Adds a row, times a factor, to a vector over all unknowns.
template <class Column>
void add_row(Column&& to, std::size_t view, const SightingRow& row, double factor) {
  to.template head<scan::Lens::kParameters>() += factor * row.head<scan::Lens::kParameters>();
  to.template segment<6>(place_of(view)) += factor * row.tail<6>();
}

}  // namespace hydroprint::registration
