#pragma once

#include <vector>

#include "sim/flow/flow_map.h"
#include "sim/pipeline/pipeline.h"
#include "sim/pipeline/stokes_pass.h"

namespace hydroprint::pipeline {

/// What there is to say of a dip in figures.
[[nodiscard]] DipFigures figures_of(const StokesPass& pass, const flow::SurfaceMap& map,
                                    const film::Profile& profile);

/// What a user has to be told of a dip with these figures.
[[nodiscard]] Warnings warnings_of(const DipFigures& figures, const DipOptions& options);

/// The part of it that says where the film's motion is not to be trusted, wherever it lands.
/// @param steps  waterlines solved; the rest is as in DipFigures
[[nodiscard]] Warnings warnings_of_motion(int steps, const std::vector<double>& passed_over_mm,
                                          double unsettled_mm);

}  // namespace hydroprint::pipeline
