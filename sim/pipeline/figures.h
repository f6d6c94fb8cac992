#pragma once

#include <cstdint>
#include <vector>

#include "sim/flow/flow_map.h"
#include "sim/pipeline/pipeline.h"
#include "sim/pipeline/stokes_pass.h"

namespace hydroprint::pipeline {

/// Computes the figures of a dip for the report. Shares are of the outer surface (Surface::inner).
[[nodiscard]] DipFigures figures_of(const StokesPass& pass, const flow::SurfaceMap& map,
                                    const DipOptions& options);

/// Sets the shares of the surface, the stretch and the stated error in `figures` for a part of the
/// surface. The shares remain relative to the whole outer surface.
/// @param counted  for each point: 1 if it belongs to the part
void measure_part(const mesh::Surface& surface, const waterline::Body& body,
                  const flow::SurfaceMap& map, const DipOptions& options,
                  const std::vector<char>& counted, DipFigures& figures);

/// Returns a set of FaceFlag for each triangle: those of its corners, by the same predicates as the
/// shares in DipFigures. Corners inside other parts do not count, as in the shares. A clamped
/// triangle may be torn or wrinkled, although the shares leave it out. A triangle with a corner
/// without film has kTrappedAir if there is such air in front of its middle.
[[nodiscard]] std::vector<std::uint8_t> face_flags(const StokesPass& pass,
                                                   const flow::SurfaceMap& map,
                                                   const DipOptions& options);

/// Returns the warnings about a dip with these figures.
[[nodiscard]] Warnings warnings_of(const DipFigures& figures, const DipOptions& options);

/// Returns only the warnings about strain, which say where the result cannot be trusted although
/// the film arrives: theta_clamped, stretch_beyond_stokes, film_torn, film_wrinkled,
/// tolerance_exceeded.
[[nodiscard]] Warnings warnings_of_strain(const DipFigures& figures, const DipOptions& options);

/// Returns only the warnings about the motion of the waterline: film_edge_reached, film_trapped,
/// air_trapped, waterlines_limited, sections_uncertain.
[[nodiscard]] Warnings warnings_of_waterline(const DipFigures& figures, const DipOptions& options);

/// Returns only the warnings about what the model of the film ignores.
[[nodiscard]] Warnings warnings_of_profile(const DipOptions& options);

/// Returns only the warnings about the film's motion, which do not depend on where the film lands.
/// @param steps  number of waterlines solved; the other parameters are as in DipFigures
[[nodiscard]] Warnings warnings_of_motion(int steps, const std::vector<double>& passed_over_mm,
                                          double unsettled_mm);

}  // namespace hydroprint::pipeline
