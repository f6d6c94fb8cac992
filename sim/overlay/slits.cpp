#include "sim/overlay/slits.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/overlay/slit_sides.h"

namespace hydroprint::overlay {
namespace {

using Eigen::Vector2d;

/// Allows for the rounding of points that are computed to be exactly one width apart.
constexpr double kTolerance = 1.01;
/// Triangles that become solid may touch in a point, which the next pass widens.
constexpr int kMostPasses = 4;

/// Decides which open triangles lie in a slit.
class SlitFinder {
 public:
  SlitFinder(const Region& region, double width_mm)
      : region_(region), width_mm_(kTolerance * width_mm), way_mm_(kLeastWayRound * width_mm) {
    const Sides sides = sides_of(region);
    places_ = places_of(region, sides);
    lengths_mm_ = sides.lengths_mm;
  }

  /// A triangle is in a slit if a corner is close to the opposite edge, which is part of another
  /// outline; if all its edges between outlines are short and there are several; or if outlines
  /// touch in a corner and both others are close to that.
  [[nodiscard]] bool is_in_slit(const Overlay::Triangle& t) const {
    if (std::any_of(t.corners.begin(), t.corners.end(),
                    [&](int corner) { return places_[corner].outline == Place::kNone; })) {
      return false;
    }
    int bridges = 0, short_bridges = 0;
    for (int i = 0; i < 3; ++i) {
      const int apex = t.corners[i], a = t.corners[(i + 1) % 3], b = t.corners[(i + 2) % 3];
      if (places_[apex].outline == Place::kSeveral && is_short(apex, a) && is_short(apex, b)) {
        return true;
      }
      if (is_border(t, i)) {
        if (are_apart(apex, a) && are_apart(apex, b) &&
            distance_mm(point(apex), point(a), point(b)) < width_mm_) {
          return true;
        }
      } else if (are_apart(a, b)) {
        ++bridges;
        short_bridges += is_short(a, b);
      }
    }
    return bridges > 1 && bridges == short_bridges;
  }

 private:
  [[nodiscard]] bool is_short(int a, int b) const {
    return (point(a) - point(b)).norm() < width_mm_;
  }

  [[nodiscard]] Vector2d point(int index) const { return to_mm(region_.overlay.points[index]); }

  [[nodiscard]] bool is_border(const Overlay::Triangle& t, int edge) const {
    const int across = t.neighbours[edge];
    return across != Overlay::kOutside && region_.is_solid[across] != 0;
  }

  [[nodiscard]] bool are_apart(int a, int b) const {
    const Place& p = places_[a];
    const Place& q = places_[b];
    if (p.outline == Place::kSeveral || q.outline == Place::kSeveral) return true;
    if (p.outline != q.outline) return true;
    const double way_mm = std::abs(p.along_mm - q.along_mm);
    return std::min(way_mm, lengths_mm_[p.outline] - way_mm) >= way_mm_;
  }

  const Region& region_;
  double width_mm_, way_mm_;
  std::vector<Place> places_;  ///< of each point
  std::vector<double> lengths_mm_;
};

void fill_slits(double width_mm, Region& region) {
  const SlitFinder finder(region, width_mm);
  std::vector<char> is_solid = region.is_solid;
  for (std::size_t t = 0; t < is_solid.size(); ++t) {
    if (is_solid[t] == 0) is_solid[t] = finder.is_in_slit(region.overlay.triangles[t]);
  }
  region.outlines = outlines_of(region.overlay, is_solid);
  region.is_solid = std::move(is_solid);
}

}  // namespace

Region close_slits(Region region, double width_mm) {
  for (int pass = 0; pass < kMostPasses; ++pass) {
    Sides sides = sides_of(region);
    bool found = add_touching_parts(places_of(region, sides), width_mm, sides);
    if (pass == 0) found = add_facing_parts(width_mm, sides) || found;
    if (!found) break;
    region = solid_region(split_at_meetings(stepped_lines(width_mm, std::move(sides))));
    fill_slits(width_mm, region);
  }
  return region;
}

std::vector<char> lies_in_slit(const Region& region, double width_mm) {
  const std::size_t size = region.outlines.size();
  std::vector<double> area_mm2(size, 0), length_mm = sides_of(region).lengths_mm;
  for (std::size_t o = 0; o < size; ++o) area_mm2[o] = -region.outlines[o].area_mm2;
  for (std::size_t o = 0; o < size; ++o) {
    const int parent = region.outlines[o].parent;
    if (region.outlines[o].area_mm2 < 0 || parent < 0) continue;
    area_mm2[parent] -= region.outlines[o].area_mm2;
    length_mm[parent] += length_mm[o];
  }
  std::vector<char> vanishes(size, 0);
  for (std::size_t o = 0; o < size; ++o) {
    const int parent = region.outlines[o].parent;
    const bool is_hole = region.outlines[o].area_mm2 < 0;
    vanishes[o] = (parent >= 0 && vanishes[parent] != 0) ||
                  (is_hole && 2 * area_mm2[o] < width_mm * length_mm[o]);
  }
  return vanishes;
}

}  // namespace hydroprint::overlay
