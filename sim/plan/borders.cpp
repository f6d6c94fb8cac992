#include "sim/plan/borders.h"

#include <algorithm>
#include <limits>

namespace hydroprint::plan {
namespace {

// Two triangles compute the place of a seam on their common edge with different rounding. Fractions
// of an edge that differ by less are the same place.
constexpr double kSamePlace = 1e-10;
constexpr double kOnSide = 1e-14;  // barycentric coordinate of the opposite corner

/// A part of a side that belongs to one fragment; fractions in the direction of the edge.
struct SidePart {
  double from = 0;
  double to = 0;
  int fragment = 0;
};

/// Returns the side of the triangle (0 to 2) that contains both points; -1 if none does.
int common_side(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  for (int k = 0; k < 3; ++k) {
    if (a[(k + 2) % 3] <= kOnSide && b[(k + 2) % 3] <= kOnSide) return k;
  }
  return -1;
}

class BorderSearch {
 public:
  BorderSearch(const Facets& facets, const Fragments& fragments)
      : facets_(facets), fragments_(fragments) {}

  Borders run() {
    for (std::size_t t = 0; t < facets_.size(); ++t) {
      if (fragments_.begin[t + 1] - fragments_.begin[t] > 1) search_inside(t);
    }
    for (std::size_t e = 0; e < facets_.edges().size(); ++e) search_edge(e);
    return std::move(borders_);
  }

 private:
  void search_inside(std::size_t triangle) {
    for (std::size_t f = fragments_.begin[triangle]; f < fragments_.begin[triangle + 1]; ++f) {
      const auto polygon = fragments_.polygon(f);
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto& a = polygon[i];
        const auto& b = polygon[(i + 1) % polygon.size()];
        if (common_side(a, b) < 0) add_inner(static_cast<int>(triangle), f, a, b);
      }
    }
  }

  void add_inner(int triangle, std::size_t fragment, const Eigen::Vector3d& a,
                 const Eigen::Vector3d& b) {
    const std::size_t other = neighbour(triangle, fragment, (a + b) / 2);
    if (other < fragment) return;  // found from the other side
    const double length = (facets_.flat(triangle, a) - facets_.flat(triangle, b)).norm();
    borders_.inner.push_back({static_cast<int>(fragment), static_cast<int>(other), {a, b}, length});
  }

  [[nodiscard]] std::size_t neighbour(int triangle, std::size_t fragment,
                                      const Eigen::Vector3d& at) const {
    const auto t = static_cast<std::size_t>(triangle);
    std::size_t nearest = fragment;
    double depth = -std::numeric_limits<double>::infinity();
    for (std::size_t f = fragments_.begin[t]; f < fragments_.begin[t + 1]; ++f) {
      if (f == fragment) continue;
      const double inside = depth_inside(fragments_.polygon(f), at);
      if (inside <= depth) continue;
      depth = inside;
      nearest = f;
    }
    return nearest;
  }

  void search_edge(std::size_t edge) {
    const auto sides = facets_.edges().sides(edge);
    const double length = facets_.frame(sides.front()).length_mm;
    parts_.resize(sides.size());
    places_ = {0, 1};
    for (std::size_t i = 0; i < sides.size(); ++i) divide_side(sides[i], parts_[i]);
    std::sort(places_.begin(), places_.end());
    double from = places_.front();
    for (const double to : places_) {
      if (to - from < kSamePlace) continue;
      borders_.across.push_back(
          {edge, from, to, (to - from) * length, borders_.edge_fragments.size()});
      for (const auto& parts : parts_)
        borders_.edge_fragments.push_back(fragment_at(parts, (from + to) / 2));
      from = to;
    }
  }

  void divide_side(int side, std::vector<SidePart>& parts) {
    parts.clear();
    const auto t = static_cast<std::size_t>(side / 3);
    if (fragments_.begin[t + 1] - fragments_.begin[t] == 1) {
      parts.push_back({0, 1, static_cast<int>(fragments_.begin[t])});
      return;
    }
    for (std::size_t f = fragments_.begin[t]; f < fragments_.begin[t + 1]; ++f)
      add_parts(side, f, parts);
  }

  void add_parts(int side, std::size_t fragment, std::vector<SidePart>& parts) {
    const auto polygon = fragments_.polygon(fragment);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const auto& a = polygon[i];
      const auto& b = polygon[(i + 1) % polygon.size()];
      if (common_side(a, b) != side % 3) continue;
      const double at_a = fraction_on(side, a[(side + 1) % 3], facets_);
      const double at_b = fraction_on(side, b[(side + 1) % 3], facets_);
      parts.push_back({std::min(at_a, at_b), std::max(at_a, at_b), static_cast<int>(fragment)});
      places_.insert(places_.end(), {std::clamp(at_a, 0.0, 1.0), std::clamp(at_b, 0.0, 1.0)});
    }
  }

  /// Returns the fragment at a place; the nearest one if rounding leaves a gap there.
  static int fragment_at(const std::vector<SidePart>& parts, double place) {
    int nearest = parts.front().fragment;
    double distance = std::numeric_limits<double>::infinity();
    for (const auto& part : parts) {
      const double d = std::max({part.from - place, place - part.to, 0.0});
      if (d >= distance) continue;
      distance = d;
      nearest = part.fragment;
    }
    return nearest;
  }

  const Facets& facets_;
  const Fragments& fragments_;
  Borders borders_;
  std::vector<std::vector<SidePart>> parts_;  ///< per side of the edge
  std::vector<double> places_;
};

}  // namespace

Borders find_borders(const Facets& facets, const Fragments& fragments) {
  return BorderSearch(facets, fragments).run();
}

double fraction_on(int side, double fraction, const Facets& facets) {
  const int first = facets.edges().sides(facets.edge(side)).front();
  return facets.same_direction(first, side) ? fraction : 1 - fraction;
}

}  // namespace hydroprint::plan
