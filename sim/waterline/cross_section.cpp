#include "sim/waterline/cross_section.h"

#include <cmath>
#include <polyclipping/clipper.hpp>

namespace hydroprint::waterline {
namespace {

namespace clip = ClipperLib;

// Clipper uses integers. With units of 1e-6 mm, a vat of one metre is within its fast 32-bit range.
constexpr double kUnits_per_mm = 1e6;
constexpr double kSlit_mm = 0.3;

clip::IntPoint to_units(const Eigen::Vector2d& p) {
  return {std::llround(p.x() * kUnits_per_mm), std::llround(p.y() * kUnits_per_mm)};
}

clip::Path to_path(const std::vector<Eigen::Vector2d>& polygon) {
  clip::Path path;
  path.reserve(polygon.size());
  for (const Eigen::Vector2d& p : polygon) path.push_back(to_units(p));
  return path;
}

std::vector<Eigen::Vector2d> from_path(const clip::Path& path) {
  std::vector<Eigen::Vector2d> polygon;
  polygon.reserve(path.size());
  for (const clip::IntPoint& p : path) {
    polygon.emplace_back(static_cast<double>(p.X) / kUnits_per_mm,
                         static_cast<double>(p.Y) / kUnits_per_mm);
  }
  return polygon;
}

void collect(const clip::PolyNode& node, int parent, CrossSection& section) {
  for (const clip::PolyNode* child : node.Childs) {
    Loop loop{from_path(child->Contour), child->IsHole(), parent};
    if (std::abs(signed_area(loop.points_mm)) < kLeastLoop_mm2) continue;
    section.push_back(std::move(loop));
    collect(*child, static_cast<int>(section.size()) - 1, section);
  }
}

/// Closes gaps narrower than kSlit_mm between curves by widening the solid and narrowing it again.
/// This joins parts that touch except for rounding errors; film does not fit between them.
void close_slits(clip::PolyTree& tree) {
  clip::Paths paths;
  clip::ClosedPathsFromPolyTree(tree, paths);
  for (const double by_mm : {0.5 * kSlit_mm, -0.5 * kSlit_mm}) {
    clip::ClipperOffset offset;
    offset.AddPaths(paths, clip::jtMiter, clip::etClosedPolygon);
    if (by_mm > 0) {
      offset.Execute(paths, by_mm * kUnits_per_mm);
    } else {
      offset.Execute(tree, by_mm * kUnits_per_mm);
    }
  }
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
  clip::Clipper clipper(clip::ioStrictlySimple | clip::ioPreserveCollinear);
  for (const Contour& contour : contours) {
    clip::Path path;
    path.reserve(contour.size());
    for (const Segment& s : contour) path.push_back(to_units(s.a_mm));
    clipper.AddPath(path, clip::ptSubject, true);
  }
  clip::PolyTree tree;
  clipper.Execute(clip::ctUnion, tree, clip::pftNonZero, clip::pftNonZero);
  if (tree.Total() > 1) close_slits(tree);
  CrossSection section;
  collect(tree, -1, section);
  return section;
}

bool is_inside(const CrossSection& section, const Eigen::Vector2d& p) {
  bool inside = false;
  for (const Loop& loop : section) {
    const auto& points = loop.points_mm;
    for (std::size_t i = 0, j = points.size() - 1; i < points.size(); j = i++) {
      const Eigen::Vector2d& a = points[i];
      const Eigen::Vector2d& b = points[j];
      if ((a.y() > p.y()) != (b.y() > p.y()) &&
          p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x()) {
        inside = !inside;
      }
    }
  }
  return inside;
}

double common_area(const std::vector<std::vector<Eigen::Vector2d>>& a,
                   const std::vector<std::vector<Eigen::Vector2d>>& b) {
  clip::Clipper clipper;
  for (const auto& polygon : a) clipper.AddPath(to_path(polygon), clip::ptSubject, true);
  for (const auto& polygon : b) clipper.AddPath(to_path(polygon), clip::ptClip, true);
  clip::Paths paths;
  clipper.Execute(clip::ctIntersection, paths, clip::pftEvenOdd, clip::pftEvenOdd);
  double area = 0;
  for (const clip::Path& path : paths) area += clip::Area(path);
  return area / (kUnits_per_mm * kUnits_per_mm);
}

}  // namespace hydroprint::waterline
