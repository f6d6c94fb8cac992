#include "tests/sim/print/polygons.h"

#include <algorithm>
#include <cmath>

#include "sim/film/outline.h"

namespace hydroprint::print {

using Eigen::Vector2d;

double distance_to_polygon(const std::vector<Vector2d>& polygon, const Vector2d& p) {
  film::Outline outline;
  outline.polygon = polygon;
  if (film::contains(outline, p)) return 0;
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d& a = polygon[i];
    const Vector2d along = polygon[(i + 1) % polygon.size()] - a;
    const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (p - a - t * along).norm());
  }
  return least;
}

}  // namespace hydroprint::print
