#pragma once

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/flow/trace.h"
#include "sim/sheet/thickness.h"

namespace hydroprint::sheet {

struct SheetOptions {
  double drag_per_mm = 0;  ///< see velocity::Sheet
  /// Sweeps end when the next would move the film by less than this.
  double tolerance_mm = 0.003;
  int most_sweeps = 6;  ///< at least 2
};

struct SheetFlow {
  flow::DipField field;
  int sweeps = 0;  ///< over the waterlines that took most
  /// By which another sweep would still move the film where it tears or folds (rms over the film of
  /// a waterline, summed over the dip).
  double unsettled_mm = 0;
};

/// The dip of a viscous sheet (section 4.3, quasistatic): velocity and thickness depend on one
/// another. A few waterlines at a time, each sweep takes the thickness at all of them from the
/// velocities of the sweep before and solves them anew, in parallel; what the sweeps converge to is
/// the solution of the coupled problem (waveform relaxation). An error of the first guess shrinks
/// six- to tenfold with each.
/// @param first  any velocities on the dip's film meshes with the right values at the edges:
///               Stokes flow is a good start
[[nodiscard]] Result<SheetFlow> sheet_flow(flow::DipField first,
                                           const RestThickness& rest_thickness,
                                           const SheetOptions& options, const Context& context);

}  // namespace hydroprint::sheet
