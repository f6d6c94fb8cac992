#include "sim/sheet/membrane.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>

namespace hydroprint::velocity {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

/// Projects a symmetric matrix onto the positive semidefinite ones.
Matrix2d positive_part(const Matrix2d& S) {
  const Eigen::SelfAdjointEigenSolver<Matrix2d> eigen(S);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

}  // namespace

MembraneEnergy membrane_energy(const FilmMesh& mesh, std::size_t triangle, double thickness_mm,
                               const Elasticity& elasticity, const ElementVector& displacement_mm,
                               Hessian kind) {
  const double nu = elasticity.poisson_ratio;
  const double stiffness = elasticity.young_modulus_mpa / (1 - nu * nu);
  const double volume_mm3 = 0.5 * twice_area_mm2(mesh, triangle) * thickness_mm;
  const Eigen::Map<const Eigen::Matrix<double, 2, 6>> d(displacement_mm.data());
  MembraneEnergy out;
  out.gradient.setZero();
  out.hessian.setZero();
  for (const QuadraturePoint& point : quadrature()) {
    const double weight = point.weight * volume_mm3;
    const auto g = shape_gradients(mesh, triangle, point.barycentric);
    const Matrix2d grad = d * g;
    const Matrix2d F = Matrix2d::Identity() + grad;
    // (F^T F - I) / 2, without cancellation for small displacements.
    const Matrix2d e = 0.5 * (grad + grad.transpose() + grad.transpose() * grad);
    const Matrix2d S = stiffness * ((1 - nu) * e + nu * e.trace() * Matrix2d::Identity());
    out.least_area_ratio = std::min(out.least_area_ratio, F.determinant());
    out.energy_mj += 0.5 * weight * S.cwiseProduct(e).sum();
    const Eigen::Matrix<double, 2, 6> force = weight * F * S * g.transpose();
    out.gradient += Eigen::Map<const ElementVector>(force.data());

    if (kind == Hessian::kNone) continue;
    // The sum of a term with the current stress and a term with the change of strain. A
    // displacement of a node along axis a changes e by sym(F^T e_a g^T); f = F g.
    const Matrix2d held = kind == Hessian::kTrue ? S : positive_part(S);
    const Matrix2d left = F * F.transpose();
    const Eigen::Matrix<double, 2, 6> f = F * g.transpose();
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        const Matrix2d cross = f.col(i) * f.col(j).transpose();
        const double stress = g.row(i) * held * g.row(j).transpose();
        out.hessian.block<2, 2>(2 * i, 2 * j) +=
            weight *
            (stress * Matrix2d::Identity() +
             stiffness * (0.5 * (1 - nu) * (g.row(i).dot(g.row(j)) * left + cross.transpose()) +
                          nu * cross));
      }
    }
  }
  return out;
}

}  // namespace hydroprint::velocity
