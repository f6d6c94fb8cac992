#pragma once

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/flow/trace.h"
#include "sim/sheet/membrane.h"
#include "sim/sheet/thickness.h"

namespace hydroprint::sheet {

/// Young's modulus makes a viscosity only with a time step (mu = Y dt / 3); the paper's belongs to
/// steps of about this length (field notes, section 1).
inline constexpr double kYoungsModulusStep_s = 0.02;

struct InertialOptions {
  velocity::Elasticity elasticity;  ///< as for steps of kYoungsModulusStep_s
  double density_kg_per_m3 = 0;
  double dip_speed_mm_per_s = 0;
  double drag_per_mm = 0;  ///< see velocity::Sheet
  /// Longest step of Algorithm 1, as a length of dip. The paper's, 0.02 s at 5 mm/s, is 0.1 mm;
  /// shorter ones cost no more here. The viscosity is the same whatever the step.
  double step_mm = 0.01;
  /// At a waterline, thickness and velocity are settled when a pass moves the film by less.
  double tolerance_mm = 0.001;
  int most_passes = 6;
};

/// The dip of the viscous sheet by Algorithm 1 (section 4.3), with inertia: waterline after
/// waterline, implicit Euler steps of a film that is elastic for the length of a step.
///
/// The steps between two waterlines are not all computed, but the last of them, those before it
/// having changed the velocity evenly: mass slows the film by what its velocity changes from the
/// waterline before, followed along with the film, over the time the waterline stands for. That
/// costs one solve a waterline however short the steps, and is as accurate as all of them, since
/// the film forgets its velocity within a fraction of a step (README.md).
/// @param first  any velocities, per unit of dip speed, on the dip's film meshes with the right
///               values at the edges: Stokes flow is a good start
/// @return kInternal if a step finds no balance however short
[[nodiscard]] Result<flow::DipField> inertial_flow(flow::DipField first,
                                                   const RestThickness& rest_thickness,
                                                   const InertialOptions& options,
                                                   const Context& context);

}  // namespace hydroprint::sheet
