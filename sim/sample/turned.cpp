#include "sim/sample/turned.h"

#include <cmath>

namespace hydroprint::sample {
namespace {

void add(Outline& outline, double radius_mm, double z_mm) {
  const OutlinePoint last = outline.back();
  outline.push_back(
      {radius_mm, z_mm, last.arc_mm + std::hypot(radius_mm - last.radius_mm, z_mm - last.z_mm)});
}

}  // namespace

void add_line(Outline& outline, double radius_mm, double z_mm, int steps) {
  const OutlinePoint from = outline.back();
  for (int i = 1; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    add(outline, from.radius_mm + t * (radius_mm - from.radius_mm),
        from.z_mm + t * (z_mm - from.z_mm));
  }
}

void add_arc(Outline& outline, double radius_mm, double z_mm, double bend_mm, double from_rad,
             double to_rad, int steps) {
  for (int i = 1; i <= steps; ++i) {
    const double angle = from_rad + (to_rad - from_rad) * i / steps;
    add(outline, radius_mm + bend_mm * std::cos(angle), z_mm + bend_mm * std::sin(angle));
  }
}

}  // namespace hydroprint::sample
