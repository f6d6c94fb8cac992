#pragma once

#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/flow/trace.h"
#include "sim/mesh/model.h"
#include "sim/mesh/surface.h"
#include "sim/pipeline/pipeline.h"
#include "sim/waterline/body.h"
#include "sim/waterline/traps.h"

namespace hydroprint::pipeline {

/// A dip before it matters what the film is like: what moves, and the Stokes flow (section 4.2)
/// that is the first answer to every question about it.
struct Start {
  mesh::Surface surface;
  Pose X_FO;             ///< as used: lowest point on the water, z = 0
  waterline::Body body;  ///< the surface placed over the film
  flow::DipField stokes;
  std::vector<double> passed_over_mm;  ///< see DipFigures
  bool stopped_at_edge = false;
  std::vector<waterline::Trap> traps;  ///< film and air closed in, largest first
};

/// Mesh, pose, waterline, film mesh, velocity. Refuses what its stages refuse.
[[nodiscard]] Result<Start> start(const mesh::Model& model, const DipOptions& options,
                                  const Context& context);

/// The flow of the viscous sheet (section 4.3) that carries this ink.
/// @param first  the flow to start from: Stokes', or the sheet's with nearly the same ink
[[nodiscard]] Result<sheet::SheetFlow> sheet_field(const flow::DipField& first,
                                                   const ink::InkField& ink,
                                                   const DipOptions& options,
                                                   const Context& context);

/// Where the film lands that moves like this.
[[nodiscard]] Result<flow::FlowMap> land(const Start& start, const flow::DipField& field,
                                         const DipOptions& options, const Context& context);

/// The dip that began so, its film without ink of its own image.
[[nodiscard]] Result<Dip> dip(const mesh::Model& model, Start begun, const DipOptions& options,
                              const Context& context);

/// The outcome, once it is known where the film lands.
/// @param unsettled_mm  see DipFigures
[[nodiscard]] Dip finish(const mesh::Model& model, Start start, flow::FlowMap map,
                         double unsettled_mm, const DipOptions& options);

}  // namespace hydroprint::pipeline
