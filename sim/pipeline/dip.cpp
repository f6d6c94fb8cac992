#include <utility>

#include "sim/pipeline/figures.h"
#include "sim/pipeline/pipeline.h"
#include "sim/pipeline/start.h"

namespace hydroprint::pipeline {

DipOptions scaled_resolution(DipOptions options, double factor) {
  options.schedule.swept_mm *= factor;
  options.mesh.size.at_waterline_mm *= factor;
  options.mesh.size.growth *= factor;
  options.mesh.size.most_mm *= factor;
  options.mesh.spacing_mm *= factor;
  options.mesh.tolerance_mm *= factor;
  options.sheet.tolerance_mm *= factor;
  if (factor < 1) options.sheet.most_sweeps += 2;
  return options;
}

Dip finish(const mesh::Model& model, Start start, flow::FlowMap map, double unsettled_mm,
           const DipOptions& options) {
  Dip dip;
  dip.figures = figures_of(start, map.surface, options.profile);
  dip.figures.unsettled_mm = unsettled_mm;
  dip.warnings = model.warnings;
  const auto add = [&](const Warnings& more) {
    dip.warnings.insert(dip.warnings.end(), more.begin(), more.end());
  };
  add(start.surface.warnings);
  add(warnings_of(dip.figures, options));
  dip.X_FO = start.X_FO;
  dip.surface = std::move(start.surface);
  dip.map = std::move(map);
  return dip;
}

Result<Dip> dip(const mesh::Model& model, const DipOptions& options, const Context& context) {
  HP_ASSIGN_OR_RETURN(Start begun, start(model, options, context));
  return dip(model, std::move(begun), options, context);
}

Result<Dip> dip(const mesh::Model& model, Start begun, const DipOptions& options,
                const Context& context) {
  if (options.film_model == FilmModel::kStokes) {
    HP_ASSIGN_OR_RETURN(flow::FlowMap map, land(begun, begun.stokes, options, context));
    return finish(model, std::move(begun), std::move(map), 0, options);
  }
  HP_ASSIGN_OR_RETURN(const sheet::SheetFlow flow,
                      sheet_field(begun.stokes, options.ink, options, context));
  HP_ASSIGN_OR_RETURN(flow::FlowMap map, land(begun, flow.field, options, context));
  return finish(model, std::move(begun), std::move(map), flow.unsettled_mm, options);
}

}  // namespace hydroprint::pipeline
