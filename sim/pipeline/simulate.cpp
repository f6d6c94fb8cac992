#include "sim/pipeline/simulate.h"

#include <utility>

#include "sim/base/run_beside.h"
#include "sim/image/figures/pictures.h"
#include "sim/image/film/film_image.h"
#include "sim/image/film/film_texture.h"
#include "sim/image/layers/surface_paint.h"
#include "sim/pipeline/dip.h"
#include "sim/pipeline/ink_passes.h"
#include "sim/pipeline/read_inputs.h"
#include "sim/pipeline/stokes_pass.h"

namespace hydroprint::pipeline {
namespace {

constexpr double kFilmMapCell_mm = 1;  ///< part of the documented format of film_map.exr

/// The first pass and, if colours are needed, the paint of the object.
struct PaintedStokesPass {
  StokesPass pass;
  std::optional<image::LayeredPaint> paint;
};

DipOptions dip_options_of(const SimulateOptions& options) {
  DipOptions out = options.dip;
  out.map.make_tiles = options.images;
  out.map = flow::for_resolution(out.map, options.dpi);
  return out;
}

int ink_passes_of(const SimulateOptions& options) {
  return options.dip.film_model == FilmModel::kSheet ? options.ink_passes : 0;
}

/// Solves the flow while the paint is read; the two are independent.
Result<PaintedStokesPass> run_painted_stokes_pass(const mesh::Model& model,
                                                  const SimulateOptions& options,
                                                  const Context& context) {
  const auto solve = [&](const Context& behind) {
    return run_stokes_pass(model, dip_options_of(options), behind);
  };
  if (!options.images && ink_passes_of(options) == 0) {
    HP_ASSIGN_OR_RETURN(StokesPass pass, solve(context));
    return PaintedStokesPass{std::move(pass), std::nullopt};
  }
  const bool needs_colour = options.images && options.needs_colour;
  const image::PaintSource source = paint_source(options.paint, options.texture);
  HP_ASSIGN_OR_RETURN(auto both, run_beside(context, solve, [&](const Context& reading) {
                        const auto& read = needs_colour ? read_paint : read_any_paint;
                        return read(model, source, options.dip.X_FO, reading);
                      }));
  return PaintedStokesPass{std::move(both.first), std::move(both.second)};
}

/// @param paint  set if colours are needed
Result<Dip> finish_dip(const mesh::Model& model, StokesPass first,
                       const std::optional<image::SurfacePaint>& paint,
                       const SimulateOptions& options, const Context& context) {
  const DipOptions dip_options = dip_options_of(options);
  const int passes = ink_passes_of(options);
  if (passes == 0 || !paint->has_colour()) {
    return dip(model, std::move(first), dip_options, context);
  }
  return dip_inked(model, std::move(first), drawing_of(*paint, dip_options.outline), passes,
                   options.dpi, dip_options, context);
}

Result<SimulatedImages> draw(const Dip& dip, const image::SurfacePaint& paint,
                             const SimulateOptions& options, const Context& context) {
  SimulatedImages out;
  const film::Outline& film = options.dip.outline;
  HP_ASSIGN_OR_RETURN(
      out.film, image::film_image(dip.surface, dip.map.tiles, paint, film, options.dpi, context));
  context.progress("pictures", 0);
  HP_ASSIGN_OR_RETURN(out.film_map,
                      image::film_map(dip.surface, dip.map, film, kFilmMapCell_mm, context));
  context.progress("pictures", 0.3);
  HP_ASSIGN_OR_RETURN(const image::ObjectViews views,
                      image::find_views(dip.surface, dip.X_FO, dip.map.tiles, context));
  HP_ASSIGN_OR_RETURN(out.stretch, image::stretch_picture(views, dip.map.surface, context));
  if (dip.figures.wrinkled_share > 0) {
    HP_ASSIGN_OR_RETURN(out.wrinkles, image::wrinkle_picture(views, dip.map.surface, context));
  }
  context.progress("pictures", 0.6);
  HP_ASSIGN_OR_RETURN(
      const image::FilmTexture printed,
      image::FilmTexture::from_image(out.film, film, image::kPictureFilmSide_px, context));
  HP_ASSIGN_OR_RETURN(out.predicted, image::predicted_picture(views, printed, context));
  return out;
}

/// Fits the paint, if there is one, to the surface.
Result<std::optional<image::SurfacePaint>> fit(const std::optional<image::LayeredPaint>& paint,
                                               const mesh::Surface& surface,
                                               const Context& context) {
  if (!paint) return std::nullopt;
  HP_ASSIGN_OR_RETURN(image::SurfacePaint fitted,
                      image::SurfacePaint::fit(*paint, surface, context));
  return fitted;
}

}  // namespace

Result<Simulation> simulate(const SimulateOptions& options, const Context& context) {
  Simulation out;
  const bool has_paint = !needs_own_colours(paint_source(options.paint, options.texture));
  HP_ASSIGN_OR_RETURN(
      out.model, read_inputs({options.mesh, options.scale, has_paint, options.images}, context));
  HP_ASSIGN_OR_RETURN(auto painted, run_painted_stokes_pass(out.model, options, context));
  auto& [first, paint] = painted;
  HP_ASSIGN_OR_RETURN(const auto fitted, fit(paint, first.surface, context));
  HP_ASSIGN_OR_RETURN(out.dip, finish_dip(out.model, std::move(first), fitted, options, context));
  if (options.images) {
    HP_ASSIGN_OR_RETURN(out.images, draw(out.dip, *fitted, options, context));
  }
  out.warnings = out.dip.warnings;
  if (!paint) return out;
  out.layers = paint->placed();
  const auto add = [&out](const Warnings& more) {
    out.warnings.insert(out.warnings.end(), more.begin(), more.end());
  };
  add(paint->warnings);
  add(fitted->warnings());
  return out;
}

}  // namespace hydroprint::pipeline
