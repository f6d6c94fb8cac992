#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/base/result.h"
#include "sim/sheet/membrane.h"
#include "sim/velocity/film_mesh.h"

namespace hydroprint::velocity {

/// Properties of the film for a step with inertia. In units of N, mm and s, density is in t/mm^3;
/// 1 kg/m^3 = 1e-12 t/mm^3.
struct StepFilm {
  Elasticity elasticity;
  double density_kg_per_m3;      ///< rho >= 0; 0: the quasistatic limit
  double drag_mpa_s_per_mm = 0;  ///< k of the water drag -k u on the underside of the film
};

/// Computes one implicit Euler step of the viscous sheet in Algorithm 1 (line 6; section 4.3).
/// During this step the film is an elastic sheet whose shape in the mesh is its rest shape (the
/// viscous update). Its velocity u at the end of the step balances eq. (3) over the film's area:
/// rho h (u - u_before) / dt + k u + grad E(dt u) = 0, where E is energy (4) as a function of the
/// displacement. The solution is a minimum in u. It is found by Newton's method with a line search
/// that starts from the linear solution. The strain is nonlinear, so rotation within a step costs
/// no energy. As dt -> 0 at fixed viscosity mu = Y dt / 3 (nu = 0.5), the solution tends to that of
/// Sheet; see sim/sheet/README.md.
/// @param thickness_mm  for each triangle, at the start of the step, positive
/// @param step_s  dt > 0
/// @param before_mm_per_s  for each node, the velocity at the start of the step; not read if the
///                         density is 0
/// @param fixed_mm_per_s  for each node, the prescribed velocity, or NaN where it is unknown
/// @return the velocity of each node; kInternal if Newton's method does not converge, or if a step
///         as long as the film is wide turns the film inside out
[[nodiscard]] Result<std::vector<Eigen::Vector2d>> sheet_step(
    const FilmMesh& mesh, const std::vector<double>& thickness_mm, const StepFilm& film,
    double step_s, const std::vector<Eigen::Vector2d>& before_mm_per_s,
    const std::vector<Eigen::Vector2d>& fixed_mm_per_s);

}  // namespace hydroprint::velocity
