#include "sim/waterline/cross_section.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "sim/overlay/disjoint_curves.h"
#include "sim/overlay/slits.h"

namespace hydroprint::waterline {
namespace {

constexpr double kSlit_mm = 0.3;

using Polygon = std::vector<Eigen::Vector2d>;

void add_curve(const Polygon& polygon, int group, std::vector<overlay::GridLine>& lines) {
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    overlay::add_line(lines, overlay::to_grid(polygon[j]), overlay::to_grid(polygon[i]), group);
  }
}

Eigen::AlignedBox2d box_of(const Polygon& polygon) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p : polygon) box.extend(p);
  return box;
}

Eigen::AlignedBox2d box_of(const std::vector<Polygon>& polygons) {
  Eigen::AlignedBox2d box;
  for (const Polygon& polygon : polygons) box.extend(box_of(polygon));
  return box;
}

/// Returns the part of the polygon with sign * p[axis] <= sign * limit (Sutherland and Hodgman,
/// 1974). The parts are joined along the limit, which leaves the even-odd rule as it is.
Polygon clipped(const Polygon& polygon, int axis, double sign, double limit) {
  Polygon kept;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Eigen::Vector2d& p = polygon[j];
    const Eigen::Vector2d& q = polygon[i];
    const double before = sign * (limit - p[axis]), after = sign * (limit - q[axis]);
    if ((before < 0) != (after < 0)) {
      kept.emplace_back(p + (q - p) * (before / (before - after)));
      kept.back()[axis] = limit;
    }
    if (after >= 0) kept.push_back(q);
  }
  return kept;
}

/// Adds the parts of the polygons in the box.
/// @return whether there are any
bool add_parts(const std::vector<Polygon>& polygons, const Eigen::AlignedBox2d& box, int group,
               std::vector<overlay::GridLine>& lines) {
  const std::size_t before = lines.size();
  for (const Polygon& polygon : polygons) {
    const Eigen::AlignedBox2d around = box_of(polygon);
    if (!box.intersects(around)) continue;
    if (box.contains(around)) {
      add_curve(polygon, group, lines);
      continue;
    }
    Polygon part = polygon;
    for (const int axis : {0, 1}) {
      part = clipped(part, axis, 1, box.max()[axis]);
      part = clipped(part, axis, -1, box.min()[axis]);
    }
    add_curve(part, group, lines);
  }
  return lines.size() > before;
}

CrossSection section_of(const overlay::Region& region) {
  const std::vector<char> is_slit = overlay::lies_in_slit(region, kSlit_mm);
  CrossSection section;
  std::vector<int> index(region.outlines.size(), -1);
  for (std::size_t o = 0; o < region.outlines.size(); ++o) {
    const overlay::Outline& outline = region.outlines[o];
    const bool is_root = outline.parent < 0;
    if (is_slit[o] != 0 || std::abs(outline.area_mm2) < kLeastLoop_mm2) continue;
    if (!is_root && index[outline.parent] < 0) continue;
    index[o] = static_cast<int>(section.size());
    Loop loop;
    for (const int point : outline.points) {
      loop.points_mm.push_back(overlay::to_mm(region.overlay.points[point]));
    }
    loop.is_hole = outline.area_mm2 < 0;
    loop.parent = is_root ? -1 : index[outline.parent];
    section.push_back(std::move(loop));
  }
  return section;
}

}  // namespace

double signed_area(const std::vector<Eigen::Vector2d>& polygon) {
  double twice = 0;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    twice += polygon[j].x() * polygon[i].y() - polygon[i].x() * polygon[j].y();
  }
  return 0.5 * twice;
}

CrossSection unite(const std::vector<Contour>& contours) {
  std::vector<overlay::GridLine> lines;
  for (const Contour& contour : contours) {
    for (std::size_t i = 0; i < contour.size(); ++i) {
      const Segment& next = contour[(i + 1) % contour.size()];
      overlay::add_line(lines, overlay::to_grid(contour[i].a_mm), overlay::to_grid(next.a_mm), 0);
    }
  }
  lines = overlay::split_at_meetings(std::move(lines));
  std::optional<overlay::Region> disjoint = overlay::region_in_disjoint_curves(lines);
  overlay::Region region = disjoint ? std::move(*disjoint) : overlay::solid_region(lines);
  if (region.outlines.size() > 1) region = overlay::close_slits(std::move(region), kSlit_mm);
  return section_of(region);
}

double area_mm2(const CrossSection& section) {
  double sum = 0;
  for (const Loop& loop : section) {
    sum += (loop.is_hole ? -1 : 1) * std::abs(signed_area(loop.points_mm));
  }
  return sum;
}

bool is_inside(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& p) {
  bool inside = false;
  for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) &&
        p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) {
      inside = !inside;
    }
  }
  return inside;
}

bool is_inside(const CrossSection& section, const Eigen::Vector2d& p) {
  bool inside = false;
  for (const Loop& loop : section) inside ^= is_inside(loop.points_mm, p);
  return inside;
}

double common_area(const std::vector<std::vector<Eigen::Vector2d>>& a,
                   const std::vector<std::vector<Eigen::Vector2d>>& b) {
  const Eigen::AlignedBox2d common = box_of(a).intersection(box_of(b));
  if (common.isEmpty()) return 0;
  std::vector<overlay::GridLine> lines;
  if (!add_parts(a, common, 0, lines) || !add_parts(b, common, 1, lines)) return 0;
  const overlay::Overlay united =
      overlay::triangulate(overlay::split_at_meetings(std::move(lines)));
  double area = 0;
  for (const overlay::Overlay::Triangle& t : united.triangles) {
    if (t.windings[0] % 2 != 0 && t.windings[1] % 2 != 0) area += overlay::area_mm2(united, t);
  }
  return area;
}

}  // namespace hydroprint::waterline
