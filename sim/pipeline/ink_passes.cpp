#include "sim/pipeline/ink_passes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/base/check.h"
#include "sim/image/film/film_image.h"
#include "sim/ink/ink_of.h"
#include "sim/pipeline/dip.h"

namespace hydroprint::pipeline {
namespace {

using Eigen::Vector2d;

/// Resolution of film images that serve only to compute their ink: finer than the cells over which
/// the ink is averaged.
constexpr double kInkDpi = 60;
/// Fraction of the points that must have converged; a few points at jumps of the map may never
/// converge.
constexpr double kMostPoints = 0.999;

/// Coarsens the tiles of the map for an image at kInkDpi: the tolerance is about half of its
/// pixels' size.
flow::MapOptions coarse(flow::MapOptions map) {
  map.tolerance_mm = 0.25;
  map.least_edge_mm = 0.5;
  return map;
}

InkPass compare(const std::vector<Vector2d>& before, const std::vector<Vector2d>& after) {
  HP_CHECK(after.size() == before.size());
  std::vector<double> moves;
  InkPass pass;
  for (std::size_t v = 0; v < before.size(); ++v) {
    const double move = (after[v] - before[v]).norm();
    if (std::isnan(move)) continue;
    moves.push_back(move);
    pass.moved_rms_mm += move * move;
    pass.moved_max_mm = std::max(pass.moved_max_mm, move);
  }
  if (moves.empty()) return pass;
  pass.moved_rms_mm = std::sqrt(pass.moved_rms_mm / static_cast<double>(moves.size()));
  const auto most = moves.begin() + static_cast<std::ptrdiff_t>(
                                        kMostPoints * static_cast<double>(moves.size() - 1));
  std::nth_element(moves.begin(), most, moves.end());
  pass.moved_most_mm = *most;
  return pass;
}

/// The sheet that carries the ink of its own film image, and the map of its landing.
struct InkedFlow {
  sheet::SheetFlow flow;
  flow::FlowMap map;
  std::vector<InkPass> passes;
};

Result<InkedFlow> ink_passes(const StokesPass& first, const FilmDrawing& draw, int most_passes,
                             double dpi, const DipOptions& options, const Context& context) {
  DipOptions rough = options;
  rough.map = coarse(options.map);
  rough.map.make_tiles = true;
  rough.states_error = false;
  InkedFlow out{{first.stokes}, {}, {}};
  HP_ASSIGN_OR_RETURN(out.map, trace_flow_map(first, out.flow.field, rough, context));
  for (int pass = 1; pass <= most_passes; ++pass) {
    HP_ASSIGN_OR_RETURN(const image::RgbImage film,
                        draw(first.surface, out.map.tiles, kInkDpi, context));
    HP_ASSIGN_OR_RETURN(
        const ink::InkField ink,
        ink::ink_of(film, options.outline, {options.profile.ink_icc_profile}, context));
    HP_ASSIGN_OR_RETURN(out.flow, sheet_field(out.flow.field, ink, options, context));
    const bool is_last = pass == most_passes;
    HP_ASSIGN_OR_RETURN(flow::FlowMap map,
                        trace_flow_map(first, out.flow.field, is_last ? options : rough, context));
    out.passes.push_back(compare(out.map.surface.film_mm, map.surface.film_mm));
    out.map = std::move(map);
    if (is_last) return out;
    if (out.passes.back().moved_most_mm < 25.4 / dpi) break;
  }
  HP_ASSIGN_OR_RETURN(out.map, trace_flow_map(first, out.flow.field, options, context));
  return out;
}

}  // namespace

FilmDrawing drawing_of(image::SurfacePaint paint, const film::Outline& outline) {
  return [paint = std::move(paint), &outline](const mesh::Surface& surface,
                                              const std::vector<flow::MappedTriangle>& tiles,
                                              double dpi, const Context& context) {
    return image::film_image(surface, tiles, paint, outline, dpi, context);
  };
}

Result<Dip> dip_inked(const mesh::Model& model, StokesPass first, const FilmDrawing& draw,
                      int most_passes, double dpi, const DipOptions& options,
                      const Context& context) {
  HP_ASSIGN_OR_RETURN(InkedFlow inked, ink_passes(first, draw, most_passes, dpi, options, context));
  Dip dip =
      assemble_dip(model, std::move(first), std::move(inked.map), inked.flow.unsettled_mm, options);
  dip.figures.ink_passes = std::move(inked.passes);
  return dip;
}

}  // namespace hydroprint::pipeline
