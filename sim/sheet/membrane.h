#pragma once

#include <Eigen/Core>
#include <limits>

#include "sim/velocity/film_mesh.h"
#include "sim/velocity/quadratic_elements.h"

namespace hydroprint::velocity {

/// What makes energy (4) of a sheet: Y / (1 - nu^2) and nu.
struct Elasticity {
  double young_modulus_mpa;  ///< Y, MPa = N/mm^2
  double poisson_ratio;      ///< nu in (-1, 1); 0.5 keeps the volume
};

/// Membrane energy of one triangle that is at rest as it lies in the mesh, and what follows from it
/// when its nodes are displaced.
struct MembraneEnergy {
  double energy_mj = 0;    ///< N mm
  ElementVector gradient;  ///< by the displacements, N; the elastic force is its negative
  ElementMatrix hessian;   ///< N/mm; zero if left out
  /// Smallest det F at the points integrated at: not positive where the film is turned inside out,
  /// which costs no energy.
  double least_area_ratio = std::numeric_limits<double>::infinity();
};

enum class Hessian {
  kNone,  ///< left out
  kTrue,
  /// Without the part that pressure in the film makes negative: never less than zero, for Newton's
  /// method where the true one is indefinite.
  kPositive,
};

/// Energy (4) of section 4.3, integrated over the triangle at rest:
/// W = Y h / (2 (1 - nu^2)) ((1 - nu) tr(e^2) + nu tr(e)^2), e = (F^T F - I) / 2 the Green strain,
/// F = I + grad d. Blind to rotation of any size. Quadratic shape functions; the integral is exact.
/// @param thickness_mm     of the triangle
/// @param displacement_mm  d of its nodes
[[nodiscard]] MembraneEnergy membrane_energy(const FilmMesh& mesh, std::size_t triangle,
                                             double thickness_mm, const Elasticity& elasticity,
                                             const ElementVector& displacement_mm,
                                             Hessian kind = Hessian::kTrue);

}  // namespace hydroprint::velocity
