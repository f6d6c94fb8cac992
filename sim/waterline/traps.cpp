#include "sim/waterline/traps.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "sim/waterline/holes.h"
#include "sim/waterline/waterlines.h"

namespace hydroprint::waterline {
namespace {

constexpr double kLeastTrap_mm2 = 1;

/// A hole of one waterline, followed from the one below.
struct FollowedHole : Hole {
  bool holds_film = false;
  bool holds_air = false;  ///< air that cannot escape
  int trap = -1;           ///< index of its trap; -1: no trap
};

std::vector<FollowedHole> followed_holes_of(const Waterline& line,
                                            const std::vector<char>& is_closed) {
  std::vector<FollowedHole> holes;
  for (Hole& hole : holes_of(line.section)) {
    const std::size_t l = hole.loop;
    const bool holds_film = !line.bounds_film.empty() && line.bounds_film[l] != 0;
    holes.push_back({std::move(hole), holds_film, !is_closed.empty() && is_closed[l] != 0, -1});
  }
  return holes;
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
  /// @param is_closed  for each loop, see holes_with_trapped_air()
  /// @param is_dip     false above the end of the dip, where film is no longer enclosed
  void follow(const Waterline& line, const std::vector<char>& is_closed, bool is_dip) {
    std::vector<FollowedHole> now = followed_holes_of(line, is_closed);
    std::vector<char> is_taken(traps_.size(), 0);
    for (FollowedHole& hole : now) {
      const int below = trap_below(hole);
      if (below < 0 ? hole.holds_film && is_dip : is_taken[below] != 0) {
        hole.trap = begin(hole, line.immersion_mm);  // newly closed, or split off from another
      } else if (below >= 0) {
        hole.trap = below;
        is_taken[below] = 1;
      }
    }
    const double half_span_mm = 0.5 * (line.immersion_mm - immersion_mm_);
    for (const FollowedHole& hole : before_) add_air(hole, half_span_mm);
    for (const FollowedHole& hole : now) {
      add_air(hole, half_span_mm);
      if (hole.trap >= 0 && hole.holds_air)
        traps_[hole.trap].air.push_back({line.immersion_mm, hole});
    }
    for (const FollowedHole& hole : before_) {
      if (hole.trap >= 0) pass(hole, now, line.immersion_mm);
    }
    before_ = std::move(now);
    immersion_mm_ = line.immersion_mm;
  }

  [[nodiscard]] std::vector<Trap> traps() const {
    std::vector<Trap> out;
    for (const Trap& trap : traps_) {
      if (trap.area_mm2 >= kLeastTrap_mm2) out.push_back(trap);
    }
    for (Trap& trap : out) {
      if (!trap.ceiling_mm) trap.air.clear();  // it is not closed after all
      std::ranges::stable_sort(trap.air, {}, &AirSection::immersion_mm);
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const Trap& a, const Trap& b) { return a.area_mm2 > b.area_mm2; });
    return out;
  }

 private:
  [[nodiscard]] int trap_below(const FollowedHole& hole) const {
    int trap = -1;
    double most_mm2 = 0;
    for (const FollowedHole& before : before_) {
      if (before.trap < 0) continue;
      const double shared_mm2 = common_area(hole, before);
      if (shared_mm2 <= most_mm2) continue;
      most_mm2 = shared_mm2;
      trap = before.trap;
    }
    return trap;
  }

  int begin(const FollowedHole& hole, double immersion_mm) {
    Trap trap;
    trap.immersion_mm = immersion_mm;
    trap.place_mm = middle_of(hole.curves.front());
    trap.area_mm2 = hole.area_mm2;
    traps_.push_back(trap);
    return static_cast<int>(traps_.size()) - 1;
  }

  void add_air(const FollowedHole& hole, double height_mm) {
    if (hole.trap >= 0 && hole.holds_air) traps_[hole.trap].air_mm3 += height_mm * hole.area_mm2;
  }

  /// Updates the trap of a hole of the previous waterline.
  void pass(const FollowedHole& before, const std::vector<FollowedHole>& now, double immersion_mm) {
    Trap& trap = traps_[before.trap];
    if (!before.holds_air) {  // otherwise the film stays where the waterline closed around it
      trap.area_mm2 = std::max(trap.area_mm2, before.area_mm2);
      return;
    }
    int above = -1;  // trap of the air above
    for (const FollowedHole& hole : now) {
      if (hole.trap < 0 || common_area(hole, before) <= 0) continue;
      if (above != before.trap) above = hole.trap;
    }
    if (above < 0) {
      trap.ceiling_mm = immersion_mm;
    } else if (above != before.trap) {
      traps_[above].air_mm3 += std::exchange(trap.air_mm3, 0.0);
      std::ranges::move(std::exchange(trap.air, {}), std::back_inserter(traps_[above].air));
    }
  }

  std::vector<Trap> traps_;
  std::vector<FollowedHole> before_;
  double immersion_mm_ = 0;
};

bool contains(const Hole& hole, const Eigen::Vector2d& point_mm) {
  bool inside = false;
  if (!hole.box_mm.contains(point_mm)) return inside;
  for (const std::vector<Eigen::Vector2d>& curve : hole.curves)
    inside ^= is_inside(curve, point_mm);
  return inside;
}

}  // namespace

bool is_in_air(const Trap& trap, const Eigen::Vector3d& point_mm) {
  const std::vector<AirSection>& air = trap.air;
  if (air.empty() || point_mm.z() < air.front().immersion_mm || point_mm.z() > *trap.ceiling_mm)
    return false;
  const auto above = std::ranges::upper_bound(air, point_mm.z(), {}, &AirSection::immersion_mm);
  const double least_mm = std::prev(above)->immersion_mm;
  const double most_mm = above == air.end() ? *trap.ceiling_mm : above->immersion_mm;
  const auto first = std::ranges::lower_bound(air, least_mm, {}, &AirSection::immersion_mm);
  const auto last = std::ranges::upper_bound(air, most_mm, {}, &AirSection::immersion_mm);
  return std::any_of(first, last, [&](const AirSection& section) {
    return contains(section.hole, point_mm.head<2>());
  });
}

std::vector<Trap> find_traps(const std::vector<const Waterline*>& lines,
                             const std::vector<std::vector<char>>& is_closed, std::size_t count) {
  Follower follower;
  for (std::size_t k = 0; k < lines.size(); ++k)
    follower.follow(*lines[k], is_closed[k], k < count);
  Waterline above;  // above the object everything is open
  if (!lines.empty()) above.immersion_mm = lines.back()->immersion_mm;
  follower.follow(above, {}, false);
  return follower.traps();
}

}  // namespace hydroprint::waterline
