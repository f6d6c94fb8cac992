#include "sim/overlay/slit_sides.h"

#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>

namespace hydroprint::overlay {
namespace {

using Eigen::Vector2d;

/// Parts shorter than this are not split off, mm.
constexpr double kLeastPart_mm = 1e-3;

/// Returns true if part of `q` lies on the open side of `p`.
bool lies_before(const Side& q, const Side& p) {
  const Vector2d along = p.b_mm - p.a_mm;
  const auto is_right = [&](const Vector2d& x) {
    return along.x() * (x - p.a_mm).y() - along.y() * (x - p.a_mm).x() < 0;
  };
  return is_right(q.a_mm) || is_right(q.b_mm);
}

/// Adds the part of `p` that is closer to `q` than the width.
void add_near_part(const Side& q, double width_mm, Side& p) {
  constexpr std::pair<double, double> kWhole = {0, 1};
  if (!p.near_parts.empty() && p.near_parts.back() == kWhole) return;
  const auto distance_at = [&](double t) { return distance_mm(p.at(t), q.a_mm, q.b_mm); };
  const auto is_near = [&](double t) { return distance_at(t) < width_mm; };
  double middle = is_near(0) ? 0 : 1;
  if (!is_near(middle)) {  // the distance is a convex function: narrows down its minimum
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
      const double third = (high - low) / 3;
      (distance_at(low + third) < distance_at(high - third) ? high -= third : low += third);
    }
    middle = 0.5 * (low + high);
    if (!is_near(middle)) return;
  }
  const auto end_towards = [&](double far) {
    if (is_near(far)) return far;
    double near = middle;
    for (int i = 0; i < 40; ++i) {
      const double half = 0.5 * (near + far);
      (is_near(half) ? near : far) = half;
    }
    return near;
  };
  p.near_parts.emplace_back(end_towards(0), end_towards(1));
}

bool are_apart(const Side& p, const Side& q, double least_mm,
               const std::vector<double>& lengths_mm) {
  if (p.outline != q.outline) return true;
  const auto between_mm = [&](const Side& from, const Side& to) {
    const double way_mm = to.along_mm - (from.along_mm + from.length_mm());
    return way_mm < -1e-6 ? way_mm + lengths_mm[p.outline] : way_mm;
  };
  return std::min(between_mm(p, q), between_mm(q, p)) >= least_mm;
}

void append_lines(Side& side, double width_mm, std::vector<GridLine>& lines) {
  std::sort(side.near_parts.begin(), side.near_parts.end());
  const double length_mm = side.length_mm();
  double reached = 0;
  const auto go_to = [&](double t, int steps) {
    const double from = reached;
    for (int i = 1; i <= steps; ++i) {
      const double next = i == steps ? t : from + (t - from) * i / steps;
      add_line(lines, to_grid(side.at(reached)), to_grid(side.at(next)), 0);
      reached = next;
    }
  };
  const double least = kLeastPart_mm / length_mm;
  for (auto [begin, end] : side.near_parts) {
    if (begin > reached + least) go_to(begin, 1);
    if (end > 1 - least) end = 1;
    if (end < reached + least) continue;
    go_to(end, static_cast<int>(std::ceil((end - reached) * length_mm / width_mm)));
  }
  if (reached < 1) go_to(1, 1);
}

}  // namespace

Sides sides_of(const Region& region) {
  Sides sides;
  for (std::size_t o = 0; o < region.outlines.size(); ++o) {
    const std::vector<int>& points = region.outlines[o].points;
    double along_mm = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const int a = points[i], b = points[(i + 1) % points.size()];
      sides.sides.push_back({a, b, to_mm(region.overlay.points[a]), to_mm(region.overlay.points[b]),
                             static_cast<int>(o), along_mm});
      along_mm += sides.sides.back().length_mm();
    }
    sides.lengths_mm.push_back(along_mm);
  }
  return sides;
}

std::vector<Place> places_of(const Region& region, const Sides& sides) {
  std::vector<Place> places(region.overlay.points.size());
  for (const Side& side : sides.sides) {
    Place& place = places[side.a];
    if (place.outline == Place::kNone) {
      place = {side.outline, side.along_mm};
    } else {
      place.outline = Place::kSeveral;
    }
  }
  return places;
}

bool add_facing_parts(double width_mm, Sides& sides) {
  using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 2, int>;
  std::vector<Box> boxes;
  boxes.reserve(sides.sides.size());
  const Vector2d margin = Vector2d::Constant(0.5 * width_mm);
  for (const Side& side : sides.sides) {
    const Vector2d low = side.a_mm.cwiseMin(side.b_mm) - margin;
    const Vector2d high = side.a_mm.cwiseMax(side.b_mm) + margin;
    boxes.emplace_back(CGAL::Bbox_2(low.x(), low.y(), high.x(), high.y()),
                       static_cast<int>(boxes.size()));
  }
  bool found = false;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& x, const Box& y) {
    Side& p = sides.sides[x.info()];
    Side& q = sides.sides[y.info()];
    if (!are_apart(p, q, kLeastWayRound * width_mm, sides.lengths_mm)) return;
    if (!lies_before(p, q) || !lies_before(q, p)) return;
    add_near_part(q, width_mm, p);
    add_near_part(p, width_mm, q);
    found = found || !p.near_parts.empty() || !q.near_parts.empty();
  });
  return found;
}

bool add_touching_parts(const std::vector<Place>& places, double width_mm, Sides& sides) {
  bool found = false;
  for (Side& side : sides.sides) {
    const double part = std::min(1.0, width_mm / side.length_mm());
    if (places[side.a].outline == Place::kSeveral) side.near_parts.emplace_back(0, part);
    if (places[side.b].outline == Place::kSeveral) side.near_parts.emplace_back(1 - part, 1);
    found = found || !side.near_parts.empty();
  }
  return found;
}

std::vector<GridLine> stepped_lines(double width_mm, Sides sides) {
  std::vector<GridLine> lines;
  for (Side& side : sides.sides) append_lines(side, width_mm, lines);
  return lines;
}

double distance_mm(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = b - a;
  const double square = along.squaredNorm();
  const double t = square > 0 ? std::clamp((p - a).dot(along) / square, 0.0, 1.0) : 0;
  return (a + t * along - p).norm();
}

}  // namespace hydroprint::overlay
