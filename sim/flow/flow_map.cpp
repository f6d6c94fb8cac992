#include "sim/flow/flow_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/base/check.h"
#include "sim/flow/jacobian.h"
#include "sim/flow/map_error.h"
#include "sim/flow/tiles.h"

namespace hydroprint::flow {
namespace {

using Eigen::Vector2d;
/// Error of the film mesh, which the number of waterlines does not show.
constexpr double kMeshError_mm = 0.01;
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

/// Returns one corner or more of each triangle: the points whose error is estimated.
std::vector<char> judged_points(const waterline::Body& body) {
  std::vector<char> out(body.points_mm.size(), 0);
  for (const Eigen::Vector3i& t : body.triangles) {
    if (out[t[0]] + out[t[1]] + out[t[2]] == 0) out[t[0]] = 1;
  }
  return out;
}

/// Returns the estimates of all points: at those that are not judged, the largest beside them.
std::vector<double> spread(const waterline::Body& body, const std::vector<char>& is_judged,
                           std::vector<double> error_mm) {
  for (const Eigen::Vector3i& t : body.triangles) {
    for (const int to : t) {
      if (is_judged[to] != 0) continue;
      for (const int from : t) {
        const bool is_more = is_judged[from] != 0 && !(error_mm[from] <= error_mm[to]);
        if (is_more && !std::isnan(error_mm[from])) error_mm[to] = error_mm[from];
      }
    }
  }
  return error_mm;
}

/// Sets the stated error of the film points: infinite where there is film, but no estimate, and
/// behind tears, where the film's thickness and thus its motion have no unique solution.
void state_error(const mesh::Surface& surface, const TracedBack& traced, const MapOptions& options,
                 SurfaceMap& map) {
  const double swelling = options.swelling.minCoeff();
  for (const int w : surface.weld) {
    const double stated_mm = std::hypot(options.error_factor * traced.error_mm[w], kMeshError_mm);
    const bool is_bare = std::isnan(traced.film_mm[w].x());
    const bool is_known = !std::isnan(stated_mm) && traced.has_torn[w] == 0;
    map.error_mm.push_back(is_bare ? kNaN : is_known ? stated_mm / swelling : HUGE_VAL);
  }
}

/// @return without `error_mm` if no error is to be stated
Result<TracedBack> trace(const waterline::Body& body, const DipField& dip, const Landings& landings,
                         const MapOptions& options, const Context& context) {
  constexpr const char* kStage = "flow map";
  TracedBack out;
  if (options.error_factor <= 0) {
    HP_ASSIGN_OR_RETURN(out.film_mm, trace_back(dip, landings.of_points(), kStage, context));
    return out;
  }
  const std::vector<char> is_judged = judged_points(body);
  HP_ASSIGN_OR_RETURN(out,
                      trace_back_with_error(dip, landings.of_points(), is_judged, kStage, context));
  out.error_mm = spread(body, is_judged, std::move(out.error_mm));
  return out;
}

}  // namespace

MapOptions for_resolution(MapOptions options, double dpi) {
  const double coarser = std::clamp(600 / dpi, 1.0, 4.0);
  options.tolerance_mm *= coarser;
  options.least_edge_mm *= coarser;
  options.pixel_mm = 25.4 / dpi;
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
  HP_ASSIGN_OR_RETURN(const TracedBack traced, trace(body, dip, landings, options, context));
  const std::vector<Vector2d>& film = traced.film_mm;
  FlowMap map;
  for (std::size_t v = 0; v < surface.points.size(); ++v) {
    const int w = surface.weld[v];
    const bool reached = !std::isnan(film[w].x());
    map.surface.film_mm.push_back(film[w].cwiseQuotient(options.swelling));
    map.surface.contact_time_s.push_back(
        reached ? body.points_mm[w].z() / options.dip_speed_mm_per_s : kNaN);
  }
  measure_stretch(surface, body, film, map.surface);
  if (!traced.error_mm.empty()) state_error(surface, traced, options, map.surface);
  if (!options.make_tiles) return map;
  HP_ASSIGN_OR_RETURN(Tiles tiles, make_tiles(body, dip, landings, film, options, context));
  map.tiles = std::move(tiles.tiles);
  map.is_limited = tiles.is_limited;
  return map;
}

}  // namespace hydroprint::flow
