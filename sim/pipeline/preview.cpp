#include "sim/pipeline/preview.h"

#include <limits>
#include <utility>

#include "sim/mesh/make_surface.h"

namespace hydroprint::pipeline {

DipOptions preview_of(DipOptions options) {
  options.film_model = FilmModel::kStokes;
  options.inertia = false;
  options.ink = {};
  options.surface_edge_mm = std::numeric_limits<double>::infinity();
  options.schedule.swept_mm = 14;
  options.mesh.size = {10, 1, 50};
  options.mesh.spacing_mm = 8;
  options.mesh.tolerance_mm = 0.2;
  options.mesh.least_mm = 1;
  options.map.make_tiles = false;
  options.states_error = false;
  return options;
}

Result<PreviewSurfaces> make_preview_surfaces(const mesh::Model& model, const mesh::Model& shape,
                                              const Context& context) {
  constexpr double kWhole_mm = std::numeric_limits<double>::infinity();
  const bool is_thinned = shape.triangles.size() != model.triangles.size();
  PreviewSurfaces out;
  HP_ASSIGN_OR_RETURN(out.whole,
                      mesh::make_surface(is_thinned ? model : shape, kWhole_mm, context));
  HP_RETURN_IF_ERROR(check_solid(out.whole, model));
  if (!is_thinned) return out;
  HP_ASSIGN_OR_RETURN(out.shown, mesh::make_surface(shape, kWhole_mm, context));
  return out;
}

Result<Dip> preview_dip(const mesh::Model& model, const PreviewSurfaces& surfaces,
                        const DipOptions& options, const Context& context) {
  const DipOptions coarse = preview_of(options);
  HP_ASSIGN_OR_RETURN(StokesPass pass, run_stokes_pass(surfaces.whole, coarse, context));
  if (surfaces.shown) {
    Pose X_FO = pass.X_FO;
    pass.body = waterline::place(*surfaces.shown, X_FO);
    const double lower_mm = pass.X_FO.translation().z() - X_FO.translation().z();
    for (Eigen::Vector3d& p : pass.body.points_mm) p.z() += lower_mm;
    pass.body.height_mm += lower_mm;
    Warnings warnings = std::move(pass.surface.warnings);
    pass.surface = *surfaces.shown;
    pass.surface.warnings = std::move(warnings);
  }
  return dip(model, std::move(pass), coarse, context);
}

}  // namespace hydroprint::pipeline
