#include "sim/waterline/holes.h"

#include <cmath>
#include <utility>

namespace hydroprint::waterline {

std::vector<Hole> holes_of(const CrossSection& section) {
  std::vector<Hole> holes;
  for (std::size_t l = 0; l < section.size(); ++l) {
    const Loop& loop = section[l];
    if (!loop.is_hole) continue;
    Hole hole{l, {loop.points_mm}, std::abs(signed_area(loop.points_mm)), {}};
    for (const Eigen::Vector2d& p : loop.points_mm) hole.box_mm.extend(p);
    for (const Loop& island : section) {
      if (island.parent != static_cast<int>(l)) continue;
      hole.curves.push_back(island.points_mm);
      hole.area_mm2 -= std::abs(signed_area(island.points_mm));
    }
    holes.push_back(std::move(hole));
  }
  return holes;
}

double common_area(const Hole& a, const Hole& b) {
  return a.box_mm.intersects(b.box_mm) ? common_area(a.curves, b.curves) : 0;
}

}  // namespace hydroprint::waterline
