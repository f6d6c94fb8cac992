#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/base/result.h"
#include "sim/sheet/membrane.h"
#include "sim/velocity/film_mesh.h"

namespace hydroprint::velocity {

/// What the film is made of, for a step with inertia. In N, mm and s a density is one in t/mm^3:
/// 1 kg/m^3 = 1e-12 t/mm^3.
struct StepFilm {
  Elasticity elasticity;
  double density_kg_per_m3;      ///< rho >= 0; 0: as light as in the quasistatic limit
  double drag_mpa_s_per_mm = 0;  ///< k of the water's drag -k u on the film's lower side
};

/// One implicit Euler step of the viscous sheet as Algorithm 1 takes it (line 6; section 4.3): for
/// this step the film is an elastic sheet that is at rest as it lies in the mesh (the viscous
/// update), and its velocity u at the end of the step balances eq. (3), over the film's area:
///   rho h (u - u_before) / dt + k u + grad of energy (4), displaced by dt u, = 0.
/// That is a minimum in u, found by Newton's method with a line search from the linear answer; the
/// strain is nonlinear, so rotation within a step costs nothing.
/// As dt -> 0 at fixed viscosity mu = Y dt / 3 (nu = 0.5) the answer tends to Sheet's; see
/// sim/sheet/README.md.
/// @param thickness_mm       per triangle, at the start of the step, positive
/// @param step_s             dt > 0
/// @param before_mm_per_s    per node of this mesh the velocity at the start of the step; not read
///                           where there is no mass
/// @param fixed_mm_per_s     per node the prescribed velocity, NaN where it is to be found
/// @return per node the velocity; kInternal if Newton's method does not converge, or to film
///         turned inside out: the step displaces film by as much as it is wide
[[nodiscard]] Result<std::vector<Eigen::Vector2d>> sheet_step(
    const FilmMesh& mesh, const std::vector<double>& thickness_mm, const StepFilm& film,
    double step_s, const std::vector<Eigen::Vector2d>& before_mm_per_s,
    const std::vector<Eigen::Vector2d>& fixed_mm_per_s);

}  // namespace hydroprint::velocity
