#pragma once

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/flow/trace.h"
#include "sim/sheet/membrane.h"
#include "sim/sheet/thickness.h"

namespace hydroprint::sheet {

/// Young's modulus defines a viscosity only together with a time step (mu = Y dt / 3). The paper's
/// modulus belongs to steps of about this length (field notes, section 1).
inline constexpr double kYoungsModulusStep_s = 0.02;

struct InertialOptions {
  velocity::Elasticity elasticity;  ///< constants for steps of kYoungsModulusStep_s
  double density_kg_per_m3 = 0;
  double dip_speed_mm_per_s = 0;
  double drag_per_mm = 0;  ///< see Sheet in sheet.h
  /// Maximum step of Algorithm 1, as a length of dip. The paper's step, 0.02 s at 5 mm/s, is 0.1
  /// mm. Shorter steps cost no more here. The viscosity does not depend on the step.
  double step_mm = 0.01;
  /// At a waterline, iterations over thickness and velocity end when an iteration moves the film by
  /// less than this.
  double tolerance_mm = 0.001;
  int most_passes = 6;
  double tear_stretch = 3;  ///< see film::Profile
};

/// Computes the dip of the viscous sheet with inertia by Algorithm 1 (section 4.3): at each
/// waterline, implicit Euler steps of a film that is elastic for the length of a step.
/// Only the last of the steps between two waterlines is computed; the velocity is assumed to change
/// evenly over the others. The inertial term uses the change of the material's velocity since the
/// previous waterline, over the time that the waterline represents. This needs one solve per
/// waterline for any step length. It is as accurate as computing all steps, because the film
/// forgets its velocity within a fraction of a step (README.md).
/// @param first  any velocities, per unit of dip speed, on the dip's film meshes, with the right
///               values at the edges; Stokes flow is a good start
/// @return with its tears; kInternal if a step does not converge even after it is shortened
[[nodiscard]] Result<flow::DipField> inertial_flow(flow::DipField first,
                                                   const RestThickness& rest_thickness,
                                                   const InertialOptions& options,
                                                   const Context& context);

}  // namespace hydroprint::sheet
