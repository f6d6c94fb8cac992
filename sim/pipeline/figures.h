#pragma once

#include <vector>

#include "sim/flow/flow_map.h"
#include "sim/pipeline/pipeline.h"
#include "sim/pipeline/stokes_pass.h"

namespace hydroprint::pipeline {

/// Computes the figures of a dip for the report.
[[nodiscard]] DipFigures figures_of(const StokesPass& pass, const flow::SurfaceMap& map,
                                    const film::Profile& profile);

/// Returns the warnings about a dip with these figures.
[[nodiscard]] Warnings warnings_of(const DipFigures& figures, const DipOptions& options);

/// Returns only the warnings about the film's motion, which do not depend on where the film lands.
/// @param steps  number of waterlines solved; the other parameters are as in DipFigures
[[nodiscard]] Warnings warnings_of_motion(int steps, const std::vector<double>& passed_over_mm,
                                          double unsettled_mm);

}  // namespace hydroprint::pipeline
