#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sim/base/result.h"
#include "sim/velocity/film_mesh.h"

namespace hydroprint::velocity {

/// The viscous sheet (section 4.3) in its quasistatic limit on one film mesh: velocities u with
/// div(2 h (D + tr(D) I)) = drag u, D = sym grad u, which is what energy (4) with nu = 0.5 comes to
/// once inertia has decayed, long before the film has moved. With all velocities prescribed at the
/// edges, Young's modulus and density drop out and only the relative thickness matters. Quadratic
/// elements, thickness constant on each triangle.
class Sheet {
 public:
  /// @param mesh         has to outlive the sheet
  /// @param drag_per_mm  k / mu = h0 / drag_length^2 (water drag on the film); 0: none
  /// @param fixed        per node the prescribed velocity, NaN where it is to be found
  Sheet(const FilmMesh& mesh, double drag_per_mm, std::vector<Eigen::Vector2d> fixed);
  ~Sheet();
  Sheet(Sheet&&) noexcept;
  Sheet& operator=(Sheet&&) noexcept;

  /// Velocities per node. The first call factors the matrix; later ones, for a thickness not much
  /// different, start from the solution before and take that factor to precondition conjugate
  /// gradients.
  /// @param thickness_mm  per triangle, positive
  /// @return kInternal if the matrix cannot be factored
  [[nodiscard]] Result<std::vector<Eigen::Vector2d>> solve(const std::vector<double>& thickness_mm);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hydroprint::velocity
