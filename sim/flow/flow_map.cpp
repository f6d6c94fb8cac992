#include "sim/flow/flow_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/base/check.h"
#include "sim/flow/jacobian.h"
#include "sim/flow/tiles.h"

namespace hydroprint::flow {
namespace {

using Eigen::Vector2d;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Sets the stretch of the film around each surface point (section 6).
void measure_stretch(const mesh::Surface& surface, const waterline::Body& body,
                     const std::vector<Vector2d>& film_mm, SurfaceMap& map) {
  HP_CHECK(film_mm.size() == body.points_mm.size());
  HP_CHECK(map.contact_time_s.size() == surface.points.size());
  std::vector<std::array<Vector2d, 3>> corners;
  corners.reserve(body.triangles.size());
  for (const Eigen::Vector3i& t : body.triangles)
    corners.push_back({film_mm[t[0]], film_mm[t[1]], film_mm[t[2]]});
  const auto stretches = point_stretch(corners, body.points_mm, body.triangles);
  for (std::size_t v = 0; v < surface.points.size(); ++v) {
    const Stretch& stretch = stretches[surface.weld[v]];
    const bool is_known = std::isfinite(stretch.most) && std::isfinite(map.contact_time_s[v]);
    map.stretch.push_back(is_known ? stretch.most : kNaN);
    map.least_stretch.push_back(is_known ? stretch.least : kNaN);
  }
}

}  // namespace

MapOptions for_resolution(MapOptions options, double dpi) {
  const double coarser = std::clamp(600 / dpi, 1.0, 4.0);
  options.tolerance_mm *= coarser;
  options.least_edge_mm *= coarser;
  return options;
}

Result<FlowMap> make_flow_map(const mesh::Surface& surface, const waterline::Body& body,
                              const DipField& dip, const waterline::Motion& motion,
                              const MapOptions& options, const Context& context) {
  HP_CHECK(dip.immersion_mm.size() == dip.fields.size());
  HP_CHECK(body.points_mm.size() == surface.points.size());
  HP_CHECK(body.triangles.size() == surface.triangles.size());
  HP_CHECK(options.dip_speed_mm_per_s > 0);
  const Landings landings(body, motion);
  HP_ASSIGN_OR_RETURN(const std::vector<Vector2d> film,
                      trace_back(dip, landings.of_points(), "flow map", context));
  FlowMap map;
  for (std::size_t v = 0; v < surface.points.size(); ++v) {
    const int w = surface.weld[v];
    const bool reached = !std::isnan(film[w].x());
    map.surface.film_mm.push_back(film[w].cwiseQuotient(options.swelling));
    map.surface.contact_time_s.push_back(
        reached ? body.points_mm[w].z() / options.dip_speed_mm_per_s : kNaN);
  }
  measure_stretch(surface, body, film, map.surface);
  if (!options.make_tiles) return map;
  HP_ASSIGN_OR_RETURN(Tiles tiles, make_tiles(body, dip, landings, film, options, context));
  map.tiles = std::move(tiles.tiles);
  map.is_limited = tiles.is_limited;
  return map;
}

}  // namespace hydroprint::flow
