#pragma once

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/flow/flow_map.h"
#include "sim/mesh/model.h"
#include "sim/pipeline/pipeline.h"
#include "sim/pipeline/stokes_pass.h"

namespace hydroprint::pipeline {

/// Computes a dip with the method of section 4: mesh, pose, waterline, film mesh, velocity, flow
/// map. Errors: those of these stages, such as kFailedPrecondition if the first contact misses the
/// film.
[[nodiscard]] Result<Dip> dip(const mesh::Model& model, const DipOptions& options,
                              const Context& context);

/// Same as above, continuing from a first pass of the same model with the same options.
[[nodiscard]] Result<Dip> dip(const mesh::Model& model, StokesPass first, const DipOptions& options,
                              const Context& context);

/// Computes figures and warnings, and combines them with the flow map and the first pass.
/// @param unsettled_mm  see DipFigures
[[nodiscard]] Dip assemble_dip(const mesh::Model& model, StokesPass first, flow::FlowMap map,
                               double unsettled_mm, const DipOptions& options);

}  // namespace hydroprint::pipeline
