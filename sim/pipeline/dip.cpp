#include "sim/pipeline/dip.h"

#include <utility>

#include "sim/pipeline/figures.h"

namespace hydroprint::pipeline {

Dip assemble_dip(const mesh::Model& model, StokesPass first, flow::FlowMap map, double unsettled_mm,
                 const DipOptions& options) {
  Dip dip;
  dip.figures = figures_of(first, map.surface, options);
  dip.face_flags = face_flags(first, map.surface, options);
  dip.figures.unsettled_mm = unsettled_mm;
  dip.figures.tiles_limited = map.is_limited;
  dip.warnings = model.warnings;
  const auto add = [&](const Warnings& more) {
    dip.warnings.insert(dip.warnings.end(), more.begin(), more.end());
  };
  add(first.surface.warnings);
  add(warnings_of(dip.figures, options));
  dip.X_FO = first.X_FO;
  dip.surface = std::move(first.surface);
  dip.map = std::move(map);
  return dip;
}

Result<Dip> dip(const mesh::Model& model, const DipOptions& options, const Context& context) {
  HP_ASSIGN_OR_RETURN(StokesPass first, run_stokes_pass(model, options, context));
  return dip(model, std::move(first), options, context);
}

Result<Dip> dip(const mesh::Model& model, StokesPass first, const DipOptions& options,
                const Context& context) {
  if (options.film_model == FilmModel::kStokes) {
    HP_ASSIGN_OR_RETURN(flow::FlowMap map, trace_flow_map(first, first.stokes, options, context));
    return assemble_dip(model, std::move(first), std::move(map), 0, options);
  }
  HP_ASSIGN_OR_RETURN(const sheet::SheetFlow flow,
                      sheet_field(first.stokes, options.ink, options, context));
  HP_ASSIGN_OR_RETURN(flow::FlowMap map, trace_flow_map(first, flow.field, options, context));
  return assemble_dip(model, std::move(first), std::move(map), flow.unsettled_mm, options);
}

}  // namespace hydroprint::pipeline
