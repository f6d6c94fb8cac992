#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sim/base/result.h"
#include "sim/velocity/film_mesh.h"

namespace hydroprint::velocity {

/// The viscous sheet (section 4.3) in its quasistatic limit on one film mesh: velocities u with
/// div(2 h (D + tr(D) I)) = drag u, D = sym grad u. This is the limit of energy (4) with nu = 0.5
/// after inertia has decayed, which is long before the film has moved. All velocities are
/// prescribed at the edges, so Young's modulus and density drop out and only the relative thickness
/// matters. Quadratic elements; the thickness is constant on each triangle.
class Sheet {
 public:
  /// @param mesh         must outlive the sheet
  /// @param drag_per_mm  k / mu = h0 / drag_length^2 (water drag on the film); 0: no drag
  /// @param fixed        for each node, the prescribed velocity, or NaN where it is unknown
  Sheet(const FilmMesh& mesh, double drag_per_mm, std::vector<Eigen::Vector2d> fixed);
  ~Sheet();
  Sheet(Sheet&&) noexcept;
  Sheet& operator=(Sheet&&) noexcept;

  /// Computes the velocity of each node. The first call factors the matrix. Later calls start from
  /// the previous solution and use that factor to precondition conjugate gradients, which is fast
  /// if the thickness has changed little.
  /// @param thickness_mm  for each triangle, positive
  /// @return kInternal if the matrix cannot be factored
  [[nodiscard]] Result<std::vector<Eigen::Vector2d>> solve(const std::vector<double>& thickness_mm);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hydroprint::velocity
