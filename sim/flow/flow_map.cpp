#include "sim/flow/flow_map.h"

#include <cmath>
#include <limits>

#include "sim/flow/jacobian.h"
#include "sim/flow/tiles.h"
#include "sim/waterline/waterlines.h"

namespace hydroprint::flow {
namespace {

using Eigen::Vector2d;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kChunk = 256;  ///< points traced per piece of parallel work

/// Landings of the welded points: the pull is the mean over the corners that meet there.
std::vector<Landing> landings(const waterline::Body& body, const waterline::Motion& motion) {
  std::vector<Landing> landing(body.points_mm.size(), {Vector2d::Zero(), kNaN, Vector2d::Zero()});
  std::vector<int> corners(body.points_mm.size(), 0);
  for (std::size_t t = 0; t < body.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int v = body.triangles[t][i];
      landing[v].pull += waterline::pull(body.corner_normals[t][i]);
      landing[v].film_can_follow |= waterline::film_can_follow(body.corner_normals[t][i]);
      ++corners[v];
    }
  }
  for (std::size_t v = 0; v < landing.size(); ++v) {
    if (corners[v] == 0) continue;
    const double immersion_mm = body.points_mm[v].z();
    landing[v].immersion_mm = immersion_mm;
    landing[v].point_mm = body.points_mm[v].head<2>() + waterline::offset_at(motion, immersion_mm);
    landing[v].pull = landing[v].pull / corners[v] + waterline::drift_at(motion, immersion_mm);
  }
  return landing;
}

/// Floating film per welded point; NaN where none arrives.
Result<std::vector<Vector2d>> trace_points(const std::vector<Landing>& landing, const DipField& dip,
                                           const Context& context) {
  std::vector<Vector2d> film(landing.size(), Vector2d::Constant(kNaN));
  const std::size_t chunks = (landing.size() + kChunk - 1) / kChunk;
  HP_RETURN_IF_ERROR(parallel_for(context, "flow map", chunks, [&](std::size_t c) -> Status {
    for (std::size_t v = c * kChunk; v < std::min((c + 1) * kChunk, landing.size()); ++v) {
      if (std::isnan(landing[v].immersion_mm)) continue;
      if (const auto point = trace_back(dip, landing[v])) film[v] = *point;
    }
    return {};
  }));
  return film;
}

/// Per surface point the stretch of the film round it (section 6).
void measure_stretch(const mesh::Surface& surface, const waterline::Body& body,
                     const std::vector<Vector2d>& film_mm, SurfaceMap& map) {
  const std::vector<Gradient> gradient = point_gradients(film_mm, body.points_mm, body.triangles);
  for (std::size_t v = 0; v < surface.points.size(); ++v) {
    const Stretch stretch = stretch_of(gradient[surface.weld[v]]);
    const bool is_known = std::isfinite(stretch.most) && std::isfinite(map.contact_time_s[v]);
    map.stretch.push_back(is_known ? stretch.most : kNaN);
    map.least_stretch.push_back(is_known ? stretch.least : kNaN);
  }
}

}  // namespace

Result<FlowMap> make_flow_map(const mesh::Surface& surface, const waterline::Body& body,
                              const DipField& dip, const waterline::Motion& motion,
                              const MapOptions& options, const Context& context) {
  const std::vector<Landing> landing = landings(body, motion);
  HP_ASSIGN_OR_RETURN(const std::vector<Vector2d> film, trace_points(landing, dip, context));
  FlowMap map;
  for (std::size_t v = 0; v < surface.points.size(); ++v) {
    const int w = surface.weld[v];
    const bool reached = !std::isnan(film[w].x());
    map.surface.film_mm.push_back(film[w].cwiseQuotient(options.swelling));
    map.surface.contact_time_s.push_back(
        reached ? landing[w].immersion_mm / options.dip_speed_mm_per_s : kNaN);
  }
  measure_stretch(surface, body, film, map.surface);
  if (!options.make_tiles) return map;
  HP_ASSIGN_OR_RETURN(map.tiles, make_tiles(body, dip, motion, film, options, context));
  return map;
}

}  // namespace hydroprint::flow
