#include "sim/pipeline/plan.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "sim/base/number_text.h"
#include "sim/base/run_beside.h"
#include "sim/image/figures/pictures.h"
#include "sim/image/film/film_image.h"
#include "sim/image/layers/surface_paint.h"
#include "sim/mesh/make_surface.h"
#include "sim/pipeline/dip.h"
#include "sim/pipeline/division.h"
#include "sim/pipeline/figures.h"
#include "sim/pipeline/ink_passes.h"
#include "sim/pipeline/read_inputs.h"
#include "sim/pipeline/stokes_pass.h"
#include "sim/plan/facets.h"
#include "sim/waterline/body.h"

namespace hydroprint::pipeline {
namespace {

/// A share of the surface that no dip reaches, above which there is a warning.
constexpr double kMostUnreached = 0.001;

DipOptions options_of(const PlanOptions& options, std::size_t k) {
  DipOptions out = options.dip;
  out.X_FO = options.immersions[k].X_FO;
  out.depth_mm = options.immersions[k].depth_mm;
  out.ink = {};
  out.map = flow::for_resolution(out.map, options.dpi);
  return out;
}

std::string name_of(std::size_t k) { return fmt::format("dip {}", k + 1); }

Error located(Error error, std::size_t k) {
  if (error.field.empty())
    error.message = name_of(k) + ": " + error.message;
  else
    error.field = fmt::format("immersions[{}].{}", k, error.field);
  return error;
}

void add_of_dip(std::size_t k, Warnings more, Warnings& warnings) {
  for (Warning& warning : more) {
    warning.where.dip = static_cast<int>(k) + 1;
    warnings.push_back(std::move(warning));
  }
}

Result<PlannedDip> stokes_dip(const mesh::Surface& surface, const PlanOptions& options,
                              std::size_t k, const Context& context) {
  DipOptions dip = options_of(options, k);
  dip.map.make_tiles = false;
  dip.states_error = false;
  HP_ASSIGN_OR_RETURN(const StokesPass pass, run_stokes_pass(surface, dip, context));
  HP_ASSIGN_OR_RETURN(flow::FlowMap map, trace_flow_map(pass, pass.stokes, dip, context));
  PlannedDip out{pass.X_FO, std::move(map.surface), {}};
  out.figures = figures_of(pass, out.map, dip);
  return out;
}

Result<std::vector<PlannedDip>> stokes_dips(const mesh::Surface& surface,
                                            const PlanOptions& options, const Context& context) {
  std::vector<PlannedDip> out;
  for (std::size_t k = 0; k < options.immersions.size(); ++k) {
    auto dip = stokes_dip(surface, options, k, context);
    if (!dip) return tl::unexpected(located(std::move(dip.error()), k));
    out.push_back(std::move(*dip));
  }
  return out;
}

std::vector<Pose> poses_of(const std::vector<PlannedDip>& dips) {
  std::vector<Pose> out;
  for (const PlannedDip& dip : dips) out.push_back(dip.X_FO);
  return out;
}

/// Returns the stretch by which the surface is divided: infinity where no film arrives.
plan::Stretch stretch_by_dip(const std::vector<PlannedDip>& dips) {
  plan::Stretch out;
  for (const PlannedDip& dip : dips) out.push_back(dip.map.stretch);
  return dividing_stretch(poses_of(dips), std::move(out));
}

void warn_of_repeats(const Plan& plan, Warnings& warnings) {
  const std::vector<Pose> X_FO = poses_of(plan.dips);
  for (std::size_t k = 1; k < X_FO.size(); ++k) {
    const auto earlier = repeated_by(X_FO, k);
    if (!earlier) continue;
    warnings.push_back({WarningCode::DIP_REPEATED,
                        fmt::format("{} lowers the object in the same orientation as {}, so it "
                                    "prints only what that one does not reach. Leave one of them "
                                    "out, or turn the object",
                                    name_of(k), name_of(*earlier)),
                        {{}, static_cast<int>(k) + 1}});
  }
}

void warn_of_division(const Plan& plan, Warnings& warnings) {
  warn_of_repeats(plan, warnings);
  for (std::size_t k = 0; k < plan.dips.size(); ++k) {
    if (plan.regions.sizes[k].pieces > 0) continue;
    warnings.push_back(
        {WarningCode::DIP_WITHOUT_REGION,
         fmt::format("{} prints nothing, because the other dips stretch the film less everywhere. "
                     "Leave it out, or turn the object",
                     name_of(k)),
         {{}, static_cast<int>(k) + 1}});
  }
  const double unreached = plan.regions.unreached_share;
  if (unreached <= kMostUnreached) return;
  warnings.push_back({WarningCode::PARTS_NOT_REACHED,
                      fmt::format("no dip reaches {} of the surface, which stays bare. Turn the "
                                  "object in one of the dips, or add a dip",
                                  percent(unreached)),
                      {OnSurface{}}});
}

Warnings warnings_of_plan(const Plan& plan, const image::SurfacePaint& paint,
                          const PlanOptions& options) {
  Warnings out = plan.model.warnings;
  const auto add = [&](const Warnings& more) { out.insert(out.end(), more.begin(), more.end()); };
  add(plan.surface.warnings);
  add(plan.paint.warnings);
  add(paint.warnings());
  add(warnings_of_profile(options.dip));
  warn_of_division(plan, out);
  for (std::size_t k = 0; k < plan.dips.size(); ++k) {
    const DipFigures& figures = plan.dips[k].figures;
    add_of_dip(k, warnings_of_waterline(figures, options.dip), out);
    add_of_dip(k, warnings_of_motion(figures.steps, figures.passed_over_mm, 0), out);
  }
  return out;
}

/// Returns the final dip: for the sheet, with the ink of the image that `draw` draws.
Result<Dip> final_dip(const Plan& plan, const PlanOptions& options, std::size_t k,
                      const FilmDrawing& draw, const Context& context) {
  const DipOptions dip_options = options_of(options, k);
  HP_ASSIGN_OR_RETURN(StokesPass first, run_stokes_pass(plan.surface, dip_options, context));
  if (options.dip.film_model == FilmModel::kStokes || options.ink_passes == 0)
    return dip(plan.model, std::move(first), dip_options, context);
  return dip_inked(plan.model, std::move(first), draw, options.ink_passes, options.dpi, dip_options,
                   context);
}

/// Returns 1 for the points in the region of a dip, else 0.
std::vector<char> points_of(const Plan& plan, int dip) {
  std::vector<char> out;
  for (const int at : plan.dip_at) out.push_back(at == dip ? 1 : 0);
  return out;
}

/// Draws the pictures of a dip: its stretch, and its ink on the object as all dips show it.
Status draw_pictures(const Plan& plan, const Dip& dip, const film::Outline& outline, DipPrint& out,
                     const Context& context) {
  context.progress("pictures", 0);
  HP_ASSIGN_OR_RETURN(const image::ObjectViews views,
                      image::find_views(dip.surface, dip.X_FO, dip.map.tiles, context));
  HP_ASSIGN_OR_RETURN(out.stretch, image::stretch_picture(views, dip.map.surface, context));
  HP_ASSIGN_OR_RETURN(const auto film,
                      image::FilmTexture::from_image(out.images.film, outline,
                                                     image::kPictureFilmSide_px, context));
  HP_ASSIGN_OR_RETURN(
      const image::ObjectViews finished,
      image::find_views(dip.surface, plan.dips.front().X_FO, dip.map.tiles, context));
  HP_ASSIGN_OR_RETURN(out.ink, image::landed_ink(finished, film, context));
  return {};
}

/// Returns a third of the area of the triangles at each point, mm2.
std::vector<double> point_areas_mm2(const mesh::Surface& surface) {
  std::vector<double> out(surface.points.size(), 0);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const double third_mm2 = plan::area_mm2(surface, t) / 3;
    for (const int v : surface.triangles[t]) out[static_cast<std::size_t>(v)] += third_mm2;
  }
  return out;
}

}  // namespace

Result<Plan> make_plan(const PlanOptions& options, const Context& context) {
  Plan out;
  const image::PaintSource source = paint_source(options.paint, options.texture);
  HP_ASSIGN_OR_RETURN(
      out.model,
      read_inputs({options.mesh, options.scale, !needs_own_colours(source), true}, context));
  HP_ASSIGN_OR_RETURN(out.surface,
                      mesh::make_surface(out.model, options.dip.surface_edge_mm, context));
  HP_RETURN_IF_ERROR(check_solid(out.surface, out.model));
  const auto paint = [&](const Context& reading) {
    return read_paint(out.model, source, options.immersions.front().X_FO, reading);
  };
  const auto solve = [&](const Context& behind) {
    return stokes_dips(out.surface, options, behind);
  };
  HP_ASSIGN_OR_RETURN(auto both, run_beside(context, solve, paint));
  out.dips = std::move(both.first);
  out.paint = std::move(both.second);
  HP_ASSIGN_OR_RETURN(Division division,
                      divide(out.surface, stretch_by_dip(out.dips), options.blend_mm, context));
  out.regions = std::move(division.regions);
  out.weights = std::move(division.weights);
  out.dip_at = plan::dips_at_points(out.surface, out.regions.fragments);
  HP_ASSIGN_OR_RETURN(out.weights_at, out.weights.at_points(out.surface, context));
  HP_ASSIGN_OR_RETURN(const image::SurfacePaint fitted,
                      image::SurfacePaint::fit(out.paint, out.surface, context));
  out.warnings = warnings_of_plan(out, fitted, options);
  return out;
}

Result<DipPrint> print_dip(const Plan& plan, const PlanOptions& options, int number,
                           const Context& context) {
  const auto k = static_cast<std::size_t>(number - 1);
  const film::Outline& outline = options.dip.outline;
  HP_ASSIGN_OR_RETURN(const image::SurfacePaint paint,
                      image::SurfacePaint::fit(plan.paint, plan.surface, context));
  const DipShare share{paint, plan.weights, number};
  auto found = final_dip(plan, options, k, drawing_of(share, outline), context);
  if (!found) return tl::unexpected(located(std::move(found.error()), k));
  Dip& dip = *found;

  DipPrint out;
  HP_ASSIGN_OR_RETURN(out.images,
                      draw_share(share, dip.surface, dip.map.tiles, outline, options.dpi, context));
  HP_RETURN_IF_ERROR(draw_pictures(plan, dip, outline, out, context));
  out.map = std::move(dip.map.surface);
  out.own = dip.figures;
  Pose X_FO = dip.X_FO;
  measure_part(plan.surface, waterline::place(plan.surface, X_FO), out.map, options_of(options, k),
               points_of(plan, number), out.own);
  add_of_dip(k, warnings_of_strain(out.own, options.dip), out.warnings);
  add_of_dip(k, warnings_of_motion(out.own.steps, {}, out.own.unsettled_mm), out.warnings);
  return out;
}

Result<image::RgbImage> combined_picture(const Plan& plan, const image::LandedInk& ink,
                                         const Context& context) {
  context.progress("pictures", 0);
  HP_ASSIGN_OR_RETURN(const image::ObjectViews views,
                      image::find_views(plan.surface, plan.dips.front().X_FO, {}, context));
  return image::ink_picture(views, ink, context);
}

double surface_area_mm2(const Plan& plan) {
  double sum_mm2 = 0;
  for (std::size_t t = 0; t < plan.surface.triangles.size(); ++t)
    sum_mm2 += plan::area_mm2(plan.surface, t);
  return sum_mm2;
}

std::optional<StretchQuantiles> stretch_of(const Plan& plan, const std::vector<DipPrint>& prints,
                                           int dip) {
  const std::vector<double> areas_mm2 = point_areas_mm2(plan.surface);
  std::vector<std::pair<double, double>> all;  // stretch, area
  double total_mm2 = 0;
  for (std::size_t v = 0; v < plan.dip_at.size(); ++v) {
    const int at = plan.dip_at[v];
    if (at == 0 || (dip != 0 && at != dip)) continue;
    const double stretch = prints[static_cast<std::size_t>(at - 1)].map.stretch[v];
    if (!std::isfinite(stretch)) continue;
    all.emplace_back(stretch, areas_mm2[v]);
    total_mm2 += areas_mm2[v];
  }
  if (all.empty()) return std::nullopt;
  std::sort(all.begin(), all.end());
  const auto quantile = [&](double share) {
    double below_mm2 = 0;
    for (const auto& [stretch, area_mm2] : all) {
      below_mm2 += area_mm2;
      if (below_mm2 >= share * total_mm2) return stretch;
    }
    return all.back().first;
  };
  return StretchQuantiles{quantile(0.5), quantile(0.95), all.back().first};
}

}  // namespace hydroprint::pipeline
