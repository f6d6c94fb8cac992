#pragma once

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/validate/findings.h"
#include "sim/validate/laboratory.h"

// The paper's experiments (section 7 and Fig. 7), one file each. Each is given what validate.cpp
// says of it, and adds what it finds.
namespace hydroprint::validate {

/// Section 7.1, Fig. 11: the same film dipped many times under drawn errors of pose and placement.
[[nodiscard]] Status repeatability(Laboratory& lab, Experiment& out, const Context& context);

/// Section 7.1, Fig. 12: cross-points of grids on a tilted board and a sphere.
[[nodiscard]] Status accuracy(Laboratory& lab, Experiment& out, const Context& context);

/// Section 7.1, Fig. 13: Stokes flow against the viscous sheet on a U-shape.
[[nodiscard]] Status models(Laboratory& lab, Experiment& out, const Context& context);

/// Section 4.3, Fig. 7: what it takes to leave out the ink's thickness.
[[nodiscard]] Status thickness(Laboratory& lab, Experiment& out, const Context& context);

/// Section 6, Fig. 9: maps of the stretch, and what one dip can print.
[[nodiscard]] Status stretch(Laboratory& lab, Experiment& out, const Context& context);

/// Section 7.2, Figs. 14 and 15: a mug and a globe.
[[nodiscard]] Status objects(Laboratory& lab, Experiment& out, const Context& context);

/// Section 8, Fig. 17: a bowl that cannot be printed.
[[nodiscard]] Status bowl(Laboratory& lab, Experiment& out, const Context& context);

}  // namespace hydroprint::validate
