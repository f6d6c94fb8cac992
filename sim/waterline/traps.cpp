#include "sim/waterline/traps.h"

#include <algorithm>
#include <cmath>

#include "sim/waterline/waterlines.h"

namespace hydroprint::waterline {
namespace {

constexpr double kLeastTrap_mm2 = 1;
/// A hole that vanishes is closed by solid if solid covers at least this share of it. Otherwise it
/// has opened.
constexpr double kClosedShare = 0.5;

using Curves = std::vector<std::vector<Eigen::Vector2d>>;

/// A hole of one waterline.
struct Hole {
  Curves curves;  ///< edges of the hole and of the islands in it
  double area_mm2 = 0;
  bool holds_film = false;
  int trap = -1;  ///< index of its trap; -1: no trap
};

std::vector<Hole> holes_of(const Waterline& line) {
  std::vector<Hole> holes;
  for (std::size_t l = 0; l < line.section.size(); ++l) {
    const Loop& loop = line.section[l];
    if (!loop.is_hole) continue;
    Hole hole;
    hole.curves = {loop.points_mm};
    hole.area_mm2 = std::abs(signed_area(loop.points_mm));
    for (const Loop& island : line.section) {
      if (island.parent != static_cast<int>(l)) continue;
      hole.curves.push_back(island.points_mm);
      hole.area_mm2 -= std::abs(signed_area(island.points_mm));
    }
    hole.holds_film = !line.bounds_film.empty() && line.bounds_film[l] != 0;
    holes.push_back(std::move(hole));
  }
  return holes;
}

Curves solid_of(const Waterline& line) {
  Curves curves;
  for (const Loop& loop : line.section) curves.push_back(loop.points_mm);
  return curves;
}

Eigen::Vector2d middle_of(const std::vector<Eigen::Vector2d>& polygon) {
  const auto [left, right] = std::minmax_element(
      polygon.begin(), polygon.end(), [](const auto& a, const auto& b) { return a.x() < b.x(); });
  const auto [low, high] = std::minmax_element(
      polygon.begin(), polygon.end(), [](const auto& a, const auto& b) { return a.y() < b.y(); });
  return {0.5 * (left->x() + right->x()), 0.5 * (low->y() + high->y())};
}

/// Follows holes from waterline to waterline.
class Follower {
 public:
  /// @param is_dip  false above the end of the dip, where film is no longer enclosed
  void follow(const Waterline& line, bool is_dip) {
    std::vector<Hole> now = holes_of(line);
    std::vector<char> is_taken(traps_.size(), 0);
    for (Hole& hole : now) {
      const int below = trap_below(hole);
      if (below < 0 ? hole.holds_film && is_dip : is_taken[below] != 0) {
        hole.trap = begin(hole, line.immersion_mm);  // newly closed, or split off from another
      } else if (below >= 0) {
        hole.trap = below;
        is_taken[below] = 1;
      }
    }
    const double span_mm = line.immersion_mm - immersion_mm_;
    const Curves solid = solid_of(line);
    for (const Hole& before : before_) {
      if (before.trap >= 0) pass(before, now, solid, line.immersion_mm, span_mm);
    }
    before_ = std::move(now);
    immersion_mm_ = line.immersion_mm;
  }

  [[nodiscard]] std::vector<Trap> traps() const {
    std::vector<Trap> out;
    for (Trap trap : traps_) {
      if (trap.area_mm2 < kLeastTrap_mm2) continue;
      if (!trap.ceiling_mm) trap.air_mm3 = 0;
      out.push_back(trap);
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Trap& a, const Trap& b) { return a.area_mm2 > b.area_mm2; });
    return out;
  }

 private:
  [[nodiscard]] int trap_below(const Hole& hole) const {
    int trap = -1;
    double most_mm2 = 0;
    for (const Hole& before : before_) {
      if (before.trap < 0) continue;
      const double shared_mm2 = common_area(hole.curves, before.curves);
      if (shared_mm2 <= most_mm2) continue;
      most_mm2 = shared_mm2;
      trap = before.trap;
    }
    return trap;
  }

  int begin(const Hole& hole, double immersion_mm) {
    Trap trap;
    trap.immersion_mm = immersion_mm;
    trap.place_mm = middle_of(hole.curves.front());
    traps_.push_back(trap);
    return static_cast<int>(traps_.size()) - 1;
  }

  /// Updates the trap of a hole of the previous waterline.
  void pass(const Hole& before, const std::vector<Hole>& now, const Curves& solid,
            double immersion_mm, double span_mm) {
    Trap& trap = traps_[before.trap];
    trap.area_mm2 = std::max(trap.area_mm2, before.area_mm2);
    double after_mm2 = 0;
    bool lasts = false;
    for (const Hole& hole : now) {
      if (common_area(hole.curves, before.curves) <= 0) continue;
      lasts = true;
      after_mm2 += hole.area_mm2;
    }
    trap.air_mm3 += 0.5 * span_mm * (before.area_mm2 + after_mm2);
    const bool is_closed =
        !lasts && common_area(before.curves, solid) > kClosedShare * before.area_mm2;
    if (is_closed) trap.ceiling_mm = immersion_mm;
  }

  std::vector<Trap> traps_;
  std::vector<Hole> before_;
  double immersion_mm_ = 0;
};

}  // namespace

std::vector<Trap> find_traps(const std::vector<Waterline>& lines,
                             const std::vector<Waterline>& beyond) {
  Follower follower;
  for (const Waterline& line : lines) follower.follow(line, true);
  for (const Waterline& line : beyond) follower.follow(line, false);
  Waterline above;  // above the object everything is open
  const std::vector<Waterline>& last = beyond.empty() ? lines : beyond;
  if (!last.empty()) above.immersion_mm = last.back().immersion_mm;
  follower.follow(above, false);
  return follower.traps();
}

}  // namespace hydroprint::waterline
