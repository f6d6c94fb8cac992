#include "sim/waterline/air.h"

#include <algorithm>
#include <boost/pending/disjoint_sets.hpp>
#include <utility>

#include "sim/waterline/holes.h"
#include "sim/waterline/waterlines.h"

namespace hydroprint::waterline {
namespace {

/// Narrowest opening through which air escapes: a slit of 0.3 mm, which sections still resolve.
constexpr double kLeastOpening_mm2 = 0.09;
/// Holes of neighbouring waterlines that overlap by this share of the smaller one are the same.
constexpr double kSameHole = 0.5;
/// Waterlines closer than this tell apart the air on both sides of walls that are thicker.
constexpr double kThinnestWall_mm = 0.3;
/// Cross-sections computed in addition to the waterlines, at most.
constexpr int kMostSections = 256;

using Curves = std::vector<std::vector<Eigen::Vector2d>>;

/// Air at one waterline: the surroundings (node 0) and the holes, whose nodes follow each other.
struct Level {
  double immersion_mm = 0;
  Curves outer;  ///< curves that separate the surroundings from the object and its holes
  std::vector<Hole> holes;
  int first_node = 0;
};

/// Air that overlaps at two levels.
struct Passage {
  int lower = 0, upper = 0;  ///< nodes
  bool is_certain = false;   ///< false: perhaps there is a thin wall between them
};

class Air {
 public:
  explicit Air(const SectionAt& section_at) : section_at_(section_at) { add_node(); }

  [[nodiscard]] Level level(double immersion_mm, const CrossSection& section) {
    Level out{immersion_mm, {}, holes_of(section), nodes_};
    for (const Loop& loop : section) {
      if (loop.parent < 0) out.outer.push_back(loop.points_mm);
    }
    for (std::size_t h = 0; h < out.holes.size(); ++h) add_node();
    return out;
  }

  /// Unites the air between two levels. All air above `upper` must be united already.
  void unite_between(const Level& lower, const Level& upper) {
    const std::vector<Passage> passages = passages_between(lower, upper);
    const double gap_mm = upper.immersion_mm - lower.immersion_mm;
    if (gap_mm > kThinnestWall_mm && sections_ < kMostSections && is_doubtful(lower, passages)) {
      ++sections_;
      const double middle_mm = lower.immersion_mm + 0.5 * gap_mm;
      const Level middle = level(middle_mm, section_at_(middle_mm));
      unite_between(middle, upper);
      unite_between(lower, middle);
      return;
    }
    for (const Passage& p : passages) connected_.union_set(p.lower, p.upper);
  }

  [[nodiscard]] bool can_escape(int node) {
    return connected_.find_set(node) == connected_.find_set(0);
  }

 private:
  void add_node() {
    connected_.link(nodes_, nodes_);  // makes room for it
    ++nodes_;
  }

  [[nodiscard]] std::vector<Passage> passages_between(const Level& lower, const Level& upper) {
    std::vector<Passage> passages;
    std::vector<char> is_open(lower.holes.size(), 0);
    for (std::size_t i = 0; i < lower.holes.size(); ++i) {
      for (std::size_t j = 0; j < upper.holes.size(); ++j) {
        const double shared_mm2 = common_area(lower.holes[i], upper.holes[j]);
        const double same_mm2 =
            kSameHole * std::min(lower.holes[i].area_mm2, upper.holes[j].area_mm2);
        if (shared_mm2 <= std::min(kLeastOpening_mm2, same_mm2)) continue;
        const int above = upper.first_node + static_cast<int>(j);
        const bool is_certain = shared_mm2 > same_mm2;
        passages.push_back({lower.first_node + static_cast<int>(i), above, is_certain});
        if (is_certain && can_escape(above)) is_open[i] = 1;
      }
      if (is_open[i] == 0 && reaches_out(lower.holes[i], upper)) {
        passages.push_back({lower.first_node + static_cast<int>(i), 0, false});
      }
    }
    for (std::size_t j = 0; j < upper.holes.size(); ++j) {
      const int node = upper.first_node + static_cast<int>(j);
      if (!can_escape(node) && reaches_out(upper.holes[j], lower))
        passages.push_back({0, node, false});
    }
    return passages;
  }

  /// Returns whether part of a hole lies in the surroundings at another level.
  [[nodiscard]] static bool reaches_out(const Hole& hole, const Level& level) {
    const double outside_mm2 = hole.area_mm2 - common_area(hole.curves, level.outer);
    return outside_mm2 > std::min(kLeastOpening_mm2, kSameHole * hole.area_mm2);
  }

  /// Returns whether uncertain passages decide if air can escape.
  [[nodiscard]] bool is_doubtful(const Level& lower, const std::vector<Passage>& passages) {
    struct Fate {
      bool is_certain = false, can_escape = false;
    };
    std::vector<Fate> fates(lower.holes.size());
    for (const Passage& p : passages) {
      if (!p.is_certain) continue;
      Fate& fate = fates[p.lower - lower.first_node];
      fate = {true, fate.can_escape || can_escape(p.upper)};
    }
    for (std::size_t i = 0; i < fates.size(); ++i) {
      if (!fates[i].is_certain && lower.holes[i].area_mm2 > kLeastOpening_mm2) return true;
    }
    return std::any_of(passages.begin(), passages.end(), [&](const Passage& p) {
      if (p.is_certain) return false;
      return p.lower == 0 || fates[p.lower - lower.first_node].can_escape != can_escape(p.upper);
    });
  }

  const SectionAt& section_at_;
  boost::disjoint_sets_with_storage<> connected_;
  int nodes_ = 0;
  int sections_ = 0;
};

}  // namespace

std::vector<std::vector<char>> holes_with_trapped_air(const std::vector<const Waterline*>& lines,
                                                      const SectionAt& section_at) {
  std::vector<std::vector<char>> is_closed(lines.size());
  if (lines.empty()) return is_closed;
  Air air(section_at);
  Level upper = air.level(lines.back()->immersion_mm, {});
  for (std::size_t k = lines.size(); k-- > 0;) {
    Level lower = air.level(lines[k]->immersion_mm, lines[k]->section);
    air.unite_between(lower, upper);
    is_closed[k].assign(lines[k]->section.size(), 0);
    for (std::size_t h = 0; h < lower.holes.size(); ++h) {
      is_closed[k][lower.holes[h].loop] = !air.can_escape(lower.first_node + static_cast<int>(h));
    }
    upper = std::move(lower);
  }
  return is_closed;
}

}  // namespace hydroprint::waterline
