#pragma once

#include <Eigen/Core>
#include <limits>

#include "sim/velocity/film_mesh.h"
#include "sim/velocity/quadratic_elements.h"

namespace hydroprint::velocity {

/// Material constants in the energy (4) of a sheet.
struct Elasticity {
  double young_modulus_mpa;  ///< Y, MPa = N/mm^2
  double poisson_ratio;      ///< nu in (-1, 1); 0.5 keeps the volume
};

/// Membrane energy of one triangle with displaced nodes, and its derivatives. The triangle's shape
/// in the mesh is its rest shape.
struct MembraneEnergy {
  double energy_mj = 0;  ///< mJ = N mm
  /// Derivative of the energy with respect to the displacements, N; the elastic force is its
  /// negative.
  ElementVector gradient;
  ElementMatrix hessian;  ///< N/mm; zero for Hessian::kNone
  /// Smallest det F at the quadrature points. It is zero or negative if the film is turned inside
  /// out, which the energy does not prevent.
  double least_area_ratio = std::numeric_limits<double>::infinity();
};

enum class Hessian {
  kNone,  ///< not computed
  kTrue,
  /// Positive semidefinite: without the negative part due to compressive stress. For Newton's
  /// method where the true Hessian is indefinite.
  kPositive,
};

/// Computes the energy (4) of section 4.3, integrated over the triangle at rest: W = Y h / (2 (1 -
/// nu^2)) ((1 - nu) tr(e^2) + nu tr(e)^2), with the Green strain e = (F^T F - I) / 2 and F = I +
/// grad d. The energy is invariant under rotation. Uses quadratic shape functions; the integral is
/// exact.
/// @param thickness_mm     of the triangle
/// @param displacement_mm  d of the triangle's nodes
[[nodiscard]] MembraneEnergy membrane_energy(const FilmMesh& mesh, std::size_t triangle,
                                             double thickness_mm, const Elasticity& elasticity,
                                             const ElementVector& displacement_mm,
                                             Hessian kind = Hessian::kTrue);

}  // namespace hydroprint::velocity
