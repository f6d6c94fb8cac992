#include "sim/overlay/outlines.h"

#include <algorithm>
#include <utility>

namespace hydroprint::overlay {
namespace {

constexpr int kNowhere = -1;

/// An edge of a triangle.
struct Edge {
  int triangle, edge;
};

/// Triangles that are connected across edges and are all solid or all open.
struct Regions {
  std::vector<int> of_triangle;  ///< region of each triangle
  int count = 1;                 ///< region 0 is open and unbounded
};

Regions regions_of(const Overlay& overlay, const std::vector<char>& is_solid) {
  Regions regions;
  regions.of_triangle.assign(overlay.triangles.size(), kNowhere);
  std::vector<int> open;
  const auto add = [&](int triangle, int region) {
    if (regions.of_triangle[triangle] != kNowhere) return;
    regions.of_triangle[triangle] = region;
    open.push_back(triangle);
  };
  const auto flood = [&](int region) {
    while (!open.empty()) {
      const int from = open.back();
      open.pop_back();
      for (const int next : overlay.triangles[from].neighbours) {
        if (next != Overlay::kOutside && is_solid[next] == is_solid[from]) add(next, region);
      }
    }
  };
  const int size = static_cast<int>(overlay.triangles.size());
  for (int t = 0; t < size; ++t) {
    const auto& neighbours = overlay.triangles[t].neighbours;
    const bool at_hull = std::count(neighbours.begin(), neighbours.end(), Overlay::kOutside) > 0;
    if (at_hull && is_solid[t] == 0) add(t, 0);
  }
  flood(0);
  for (int t = 0; t < size; ++t) {
    if (regions.of_triangle[t] != kNowhere) continue;
    add(t, regions.count);
    flood(regions.count++);
  }
  return regions;
}

/// Follows the edges between solid and open triangles.
class Tracer {
 public:
  Tracer(const Overlay& overlay, const std::vector<char>& is_solid)
      : overlay_(overlay),
        is_solid_(is_solid),
        regions_(regions_of(overlay, is_solid)),
        is_seen_(3 * overlay.triangles.size(), 0),
        position_(overlay.points.size(), kNowhere),
        outline_around_(regions_.count, kNowhere) {}

  std::vector<Outline> trace() {
    for (int t = 0; t < static_cast<int>(overlay_.triangles.size()); ++t) {
      for (int e = 0; e < 3; ++e) {
        if (is_border({t, e}) && is_seen_[3 * t + e] == 0) follow({t, e});
      }
    }
    for (std::size_t o = 0; o < outlines_.size(); ++o) outlines_[o].parent = parent_of(o);
    return parents_first();
  }

 private:
  [[nodiscard]] bool is_border(Edge at) const {
    if (is_solid_[at.triangle] == 0) return false;
    const int across = overlay_.triangles[at.triangle].neighbours[at.edge];
    return across == Overlay::kOutside || is_solid_[across] == 0;
  }

  [[nodiscard]] int start_of(Edge at) const {
    return overlay_.triangles[at.triangle].corners[(at.edge + 1) % 3];
  }

  [[nodiscard]] int open_region_at(Edge at) const {
    const int across = overlay_.triangles[at.triangle].neighbours[at.edge];
    return across == Overlay::kOutside ? 0 : regions_.of_triangle[across];
  }

  /// Returns the next edge of the border, turning through solid triangles around the end point.
  [[nodiscard]] Edge next(Edge at) const {
    at.edge = (at.edge + 1) % 3;
    while (!is_border(at)) {
      const int across = overlay_.triangles[at.triangle].neighbours[at.edge];
      const auto& back = overlay_.triangles[across].neighbours;
      const auto shared = std::find(back.begin(), back.end(), at.triangle) - back.begin();
      at = {across, static_cast<int>(shared + 1) % 3};
    }
    return at;
  }

  /// Follows the border until it closes. Cuts off an outline wherever it returns to a point.
  void follow(Edge at) {
    std::vector<Edge> path;
    const auto cut_off = [&](int from) {
      for (std::size_t i = from; i < path.size(); ++i) position_[start_of(path[i])] = kNowhere;
      add_outline({path.begin() + from, path.end()});
      path.resize(from);
    };
    for (; is_seen_[3 * at.triangle + at.edge] == 0; at = next(at)) {
      is_seen_[3 * at.triangle + at.edge] = 1;
      int& position = position_[start_of(at)];
      if (position != kNowhere) cut_off(position);
      position = static_cast<int>(path.size());
      path.push_back(at);
    }
    cut_off(0);
  }

  void add_outline(const std::vector<Edge>& path) {
    Outline outline;
    for (const Edge& at : path) outline.points.push_back(start_of(at));
    outline.area_mm2 = area_mm2(overlay_.points, outline.points);
    const int index = static_cast<int>(outlines_.size());
    if (outline.area_mm2 > 0) outline_around_[regions_.of_triangle[path.front().triangle]] = index;
    // Where outlines touch, a hole may consist of several regions.
    for (const Edge& at : path) {
      if (outline.area_mm2 <= 0) outline_around_[open_region_at(at)] = index;
    }
    outlines_.push_back(std::move(outline));
    paths_.push_back(path);
  }

  [[nodiscard]] int parent_of(std::size_t outline) const {
    const std::vector<Edge>& path = paths_[outline];
    if (outlines_[outline].area_mm2 <= 0) {
      return outline_around_[regions_.of_triangle[path.front().triangle]];
    }
    // Where outlines touch, an edge may border a region between them, which none surrounds.
    for (const Edge& at : path) {
      const int around = outline_around_[open_region_at(at)];
      if (around != kNowhere) return around;
    }
    return kNowhere;
  }

  [[nodiscard]] std::vector<Outline> parents_first() {
    std::vector<std::vector<int>> children(outlines_.size());
    std::vector<int> stack, place(outlines_.size(), kNowhere);
    for (int o = static_cast<int>(outlines_.size()) - 1; o >= 0; --o) {
      const int parent = outlines_[o].parent;
      (parent == kNowhere ? stack : children[parent]).push_back(o);
    }
    std::vector<Outline> sorted;
    while (!stack.empty()) {
      const int o = stack.back();
      stack.pop_back();
      place[o] = static_cast<int>(sorted.size());
      sorted.push_back(std::move(outlines_[o]));
      int& parent = sorted.back().parent;
      if (parent != kNowhere) parent = place[parent];
      stack.insert(stack.end(), children[o].begin(), children[o].end());
    }
    return sorted;
  }

  const Overlay& overlay_;
  const std::vector<char>& is_solid_;
  Regions regions_;
  std::vector<char> is_seen_;        ///< for each edge
  std::vector<int> position_;        ///< of each point on the current path; kNowhere: not on it
  std::vector<int> outline_around_;  ///< of each region; kNowhere: none
  std::vector<Outline> outlines_;
  std::vector<std::vector<Edge>> paths_;
};

}  // namespace

double area_mm2(const std::vector<GridPoint>& points, const std::vector<int>& curve) {
  double twice = 0;
  const GridPoint& origin = points[curve.front()];
  for (std::size_t i = 0, j = curve.size() - 1; i < curve.size(); j = i++) {
    const GridPoint& p = points[curve[j]];
    const GridPoint& q = points[curve[i]];
    twice += static_cast<double>(p.x - origin.x) * static_cast<double>(q.y - origin.y) -
             static_cast<double>(p.y - origin.y) * static_cast<double>(q.x - origin.x);
  }
  return 0.5 * twice * kGridSquare_mm2;
}

std::vector<Outline> outlines_of(const Overlay& overlay, const std::vector<char>& is_solid) {
  return Tracer(overlay, is_solid).trace();
}

Region solid_region(const std::vector<GridLine>& lines) {
  Region region;
  region.overlay = triangulate(lines);
  for (const Overlay::Triangle& t : region.overlay.triangles) {
    region.is_solid.push_back(t.windings[0] != 0);
  }
  region.outlines = outlines_of(region.overlay, region.is_solid);
  return region;
}

}  // namespace hydroprint::overlay
