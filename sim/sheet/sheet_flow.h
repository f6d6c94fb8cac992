#pragma once

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/flow/trace.h"
#include "sim/sheet/thickness.h"

namespace hydroprint::sheet {

struct SheetOptions {
  double drag_per_mm = 0;  ///< see Sheet in sheet.h
  /// Sweeps end when the next sweep would move the film by less than this.
  double tolerance_mm = 0.003;
  int most_sweeps = 6;      ///< at least 2
  double tear_stretch = 3;  ///< see film::Profile
};

struct SheetFlow {
  flow::DipField field;  ///< with its tears
  int sweeps = 0;        ///< largest number of sweeps of any group of waterlines
  /// Displacement in the last sweep of groups of waterlines that did not converge, where film tears
  /// or folds (rms over the film of a waterline, summed over the dip).
  double unsettled_mm = 0;
};

/// Computes the dip of a viscous sheet (section 4.3, quasistatic), in which velocity and thickness
/// depend on each other. Solves a few waterlines at a time by waveform relaxation: each sweep
/// computes the thickness at all these waterlines from the previous velocities, then solves for new
/// velocities in parallel. The sweeps converge to the solution of the coupled problem. Each sweep
/// reduces the error of the initial guess six- to tenfold.
/// @param first  any velocities on the dip's film meshes, with the right values at the edges;
///               Stokes flow is a good start
[[nodiscard]] Result<SheetFlow> sheet_flow(flow::DipField first,
                                           const RestThickness& rest_thickness,
                                           const SheetOptions& options, const Context& context);

}  // namespace hydroprint::sheet
