#pragma once

#include <optional>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/flow/trace.h"
#include "sim/mesh/model.h"
#include "sim/mesh/surface.h"
#include "sim/pipeline/pipeline.h"
#include "sim/waterline/body.h"
#include "sim/waterline/check_sections.h"
#include "sim/waterline/traps.h"
#include "sim/waterline/waterlines.h"

namespace hydroprint::pipeline {

/// The first pass of a dip, which does not depend on the film's ink: the placed object and the
/// Stokes flow (section 4.2).
struct StokesPass {
  mesh::Surface surface;
  Pose X_FO;             ///< pose as used: lowest point on the water, z = 0
  waterline::Body body;  ///< the surface placed over the film
  flow::DipField stokes;
  std::vector<double> passed_over_mm;  ///< see DipFigures
  bool stopped_at_edge = false;
  std::vector<waterline::Trap> traps;            ///< trapped film and air, largest first
  waterline::Coarseness coarse;                  ///< where waterlines are further apart than wanted
  std::vector<waterline::SectionArea> sections;  ///< one per waterline
  /// Set for meshes that are not closed, if their sections do not agree with their volume.
  std::optional<waterline::SectionsOff> sections_off;
};

/// Returns kInvalidArgument for a surface without thickness, which encloses nothing and would let
/// no waterline exist; the message names the model.
[[nodiscard]] Status check_solid(const mesh::Surface& surface, const mesh::Model& model);

/// Computes surface, pose, waterlines, film meshes and velocities. Returns the errors of its
/// stages.
[[nodiscard]] Result<StokesPass> run_stokes_pass(const mesh::Model& model,
                                                 const DipOptions& options, const Context& context);

/// Same as above, for a surface made before by mesh::make_surface().
[[nodiscard]] Result<StokesPass> run_stokes_pass(mesh::Surface surface, const DipOptions& options,
                                                 const Context& context);

/// Computes the flow of the viscous sheet (section 4.3) that carries this ink.
/// @param first  the starting flow: Stokes flow, or that of the sheet with nearly the same ink
[[nodiscard]] Result<sheet::SheetFlow> sheet_field(const flow::DipField& first,
                                                   const ink::InkField& ink,
                                                   const DipOptions& options,
                                                   const Context& context);

/// Traces where a film that moves like `field` lands on the object (section 4.5).
[[nodiscard]] Result<flow::FlowMap> trace_flow_map(const StokesPass& pass,
                                                   const flow::DipField& field,
                                                   const DipOptions& options,
                                                   const Context& context);

}  // namespace hydroprint::pipeline
