#include "sim/pipeline/simulate.h"

#include <utility>

#include "sim/base/run_beside.h"
#include "sim/image/figures/pictures.h"
#include "sim/image/film/film_image.h"
#include "sim/image/film/film_texture.h"
#include "sim/image/layers/surface_paint.h"
#include "sim/mesh/make_surface.h"
#include "sim/pipeline/dip.h"
#include "sim/pipeline/dip_images.h"
#include "sim/pipeline/figures.h"
#include "sim/pipeline/ink_passes.h"
#include "sim/pipeline/read_inputs.h"
#include "sim/pipeline/stokes_pass.h"
#include "sim/waterline/body.h"

namespace hydroprint::pipeline {
namespace {

constexpr double kFilmMapCell_mm = 1;  ///< part of the documented format of film_map.exr

/// The surface of a plan, divided among its dips.
struct Planned {
  mesh::Surface surface;
  Division division;
};

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

/// Divides the surface as the plan did; nullopt without a plan.
Result<std::optional<Planned>> planned(const mesh::Model& model, const SimulateOptions& options,
                                       const Context& context) {
  if (!options.share) return std::nullopt;
  Planned out;
  HP_ASSIGN_OR_RETURN(out.surface, mesh::make_surface(model, options.dip.surface_edge_mm, context));
  HP_RETURN_IF_ERROR(check_solid(out.surface, model));
  HP_ASSIGN_OR_RETURN(out.division, divide_as_planned(out.surface, *options.share, context));
  return out;
}

/// Solves the flow while the paint is read; the two are independent.
/// @param surface  made before; nullptr: not yet
Result<PaintedStokesPass> run_painted_stokes_pass(const mesh::Model& model,
                                                  const mesh::Surface* surface,
                                                  const SimulateOptions& options,
                                                  const Context& context) {
  const auto solve = [&](const Context& behind) {
    return surface == nullptr ? run_stokes_pass(model, dip_options_of(options), behind)
                              : run_stokes_pass(*surface, dip_options_of(options), behind);
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

/// Compares the pose of a dip with its plan, under Stokes flow.
Result<PlanDeviation> compare(const Planned& planned, const StokesPass& pass,
                              const SimulateOptions& options, const Context& context) {
  DipOptions dip = dip_options_of(options);
  dip.map.make_tiles = false;
  dip.states_error = false;
  HP_ASSIGN_OR_RETURN(const flow::FlowMap map, trace_flow_map(pass, pass.stokes, dip, context));
  return deviation_from(*options.share, planned.division, planned.surface, pass.X_FO,
                        map.surface.stretch, context);
}

/// What the film prints: the paint, of a planned dip only its share.
struct Print {
  const image::SurfacePaint& paint;
  std::optional<DipShare> share;
};

FilmDrawing print_drawing(const Print& print, const film::Outline& outline) {
  return print.share ? drawing_of(*print.share, outline) : drawing_of(print.paint, outline);
}

/// @param print  set if colours are needed
Result<Dip> finish_dip(const mesh::Model& model, StokesPass first,
                       const std::optional<Print>& print, const SimulateOptions& options,
                       const Context& context) {
  const DipOptions dip_options = dip_options_of(options);
  const int passes = ink_passes_of(options);
  if (passes == 0 || !print->paint.has_colour()) {
    return dip(model, std::move(first), dip_options, context);
  }
  return dip_inked(model, std::move(first), print_drawing(*print, dip_options.outline), passes,
                   options.dpi, dip_options, context);
}

/// Measures strain only where the dip of a plan prints, and warns only of that. Coverage stays that
/// of the whole surface; what the dip does not reach of its region is in PlanDeviation.
void measure_region(const mesh::Model& model, const Planned& planned,
                    const SimulateOptions& options, Dip& dip) {
  std::vector<char> is_own;
  for (const int at : plan::dips_at_points(planned.surface, planned.division.regions.fragments))
    is_own.push_back(at == options.share->dip ? 1 : 0);
  const double coverage = dip.figures.coverage;
  Pose X_FO = dip.X_FO;
  measure_part(dip.surface, waterline::place(dip.surface, X_FO), dip.map.surface,
               dip_options_of(options), is_own, dip.figures);
  dip.figures.coverage = coverage;
  dip.warnings = model.warnings;
  const auto add = [&dip](const Warnings& more) {
    dip.warnings.insert(dip.warnings.end(), more.begin(), more.end());
  };
  add(dip.surface.warnings);
  add(warnings_of(dip.figures, options.dip));
  std::erase_if(dip.warnings,
                [](const Warning& w) { return w.code == WarningCode::PARTS_NOT_REACHED; });
}

Status draw_film(const Dip& dip, const Print& print, const SimulateOptions& options,
                 SimulatedImages& out, const Context& context) {
  const film::Outline& film = options.dip.outline;
  if (!print.share) {
    HP_ASSIGN_OR_RETURN(out.film, image::film_image(dip.surface, dip.map.tiles, print.paint, film,
                                                    options.dpi, context));
    return {};
  }
  HP_ASSIGN_OR_RETURN(DipImages images, draw_share(*print.share, dip.surface, dip.map.tiles, film,
                                                   options.dpi, context));
  out.film = std::move(images.film);
  out.complete = std::move(images.complete);
  out.mask = std::move(images.mask);
  return {};
}

Result<SimulatedImages> draw(const Dip& dip, const Print& print, const SimulateOptions& options,
                             const Context& context) {
  SimulatedImages out;
  const film::Outline& film = options.dip.outline;
  HP_RETURN_IF_ERROR(draw_film(dip, print, options, out, context));
  context.progress("pictures", 0);
  HP_ASSIGN_OR_RETURN(out.film_map,
                      image::film_map(dip.surface, dip.map, film, kFilmMapCell_mm, context));
  context.progress("pictures", 0.3);
  HP_ASSIGN_OR_RETURN(const image::ObjectViews views,
                      image::find_views(dip.surface, dip.X_FO, dip.map.tiles, context));
  HP_ASSIGN_OR_RETURN(out.stretch, image::stretch_picture(views, dip.map.surface, context));
  HP_ASSIGN_OR_RETURN(out.error, image::error_picture(views, dip.map.surface, context));
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
  HP_ASSIGN_OR_RETURN(const auto plan, planned(out.model, options, context));
  HP_ASSIGN_OR_RETURN(
      auto painted,
      run_painted_stokes_pass(out.model, plan ? &plan->surface : nullptr, options, context));
  auto& [first, paint] = painted;
  if (plan) {
    HP_ASSIGN_OR_RETURN(out.deviation, compare(*plan, first, options, context));
  }
  HP_ASSIGN_OR_RETURN(const auto fitted, fit(paint, first.surface, context));
  std::optional<Print> print;
  if (fitted) print.emplace(Print{*fitted, {}});
  if (print && plan)
    print->share.emplace(DipShare{*fitted, plan->division.weights, options.share->dip});
  HP_ASSIGN_OR_RETURN(out.dip, finish_dip(out.model, std::move(first), print, options, context));
  if (plan) measure_region(out.model, *plan, options, out.dip);
  if (options.images) {
    HP_ASSIGN_OR_RETURN(out.images, draw(out.dip, *print, options, context));
  }
  out.warnings = out.dip.warnings;
  if (out.deviation) {
    const Warnings more = warnings_of_deviation(*out.deviation, *options.share);
    out.warnings.insert(out.warnings.begin(), more.begin(), more.end());
  }
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
