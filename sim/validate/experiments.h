#pragma once

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/validate/experiment_context.h"
#include "sim/validate/experiment_result.h"

// The paper's experiments (section 7 and Fig. 7), one file each. Each function receives an
// Experiment with name and title from validate.cpp and adds its results.
namespace hydroprint::validate {

/// Section 7.1, Fig. 11: the same film dipped many times with random errors of pose and placement.
[[nodiscard]] Status repeatability(ExperimentContext& setup, Experiment& out,
                                   const Context& context);

/// Section 7.1, Fig. 12: cross-points of grids on a tilted board and a sphere.
[[nodiscard]] Status accuracy(ExperimentContext& setup, Experiment& out, const Context& context);

/// Section 7.1, Fig. 13: Stokes flow against the viscous sheet on a U-shape.
[[nodiscard]] Status models(ExperimentContext& setup, Experiment& out, const Context& context);

/// Section 4.3, Fig. 7: the error that results from ignoring the ink's thickness.
[[nodiscard]] Status thickness(ExperimentContext& setup, Experiment& out, const Context& context);

/// Section 6, Fig. 9: maps of the stretch, and the faces that one dip can print.
[[nodiscard]] Status stretch(ExperimentContext& setup, Experiment& out, const Context& context);

/// Section 7.2, Figs. 14 and 15: a mug and a globe.
[[nodiscard]] Status objects(ExperimentContext& setup, Experiment& out, const Context& context);

/// Section 8, Fig. 17: a bowl that cannot be printed.
[[nodiscard]] Status bowl(ExperimentContext& setup, Experiment& out, const Context& context);

}  // namespace hydroprint::validate
