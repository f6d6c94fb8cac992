#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sim/base/result.h"
#include "sim/velocity/film_mesh.h"
#include "sim/velocity/locator.h"
#include "sim/waterline/pull_index.h"

namespace hydroprint::velocity {

/// Film velocity at one immersion, per unit of dip speed: quadratic on the triangles of the film
/// mesh.
class VelocityField {
 public:
  /// No film anywhere.
  VelocityField() = default;
  VelocityField(FilmMesh mesh, std::vector<Eigen::Vector2d> nodes);

  /// Other velocities on the same film mesh, which the two then share.
  [[nodiscard]] VelocityField with(std::vector<Eigen::Vector2d> nodes) const;

  /// Velocity at a point of the film, or at its nearest point if it lies up to `reach_mm` outside.
  /// @param triangle  where to look first (-1: anywhere); becomes the triangle found
  /// @return false, leaving `velocity` alone, where there is no film within reach
  [[nodiscard]] bool at(const Eigen::Vector2d& point_mm, double reach_mm, Eigen::Vector2d& velocity,
                        int& triangle) const;
  [[nodiscard]] bool at(const Eigen::Vector2d& point_mm, double reach_mm,
                        Eigen::Vector2d& velocity) const;

  /// Velocity at the point of the film nearest to this one, zero if none is within the locator's
  /// reach.
  /// @return how far outside the film the point lies, mm; kNoFilm_mm if beyond reach
  double nearest(const Eigen::Vector2d& point_mm, Eigen::Vector2d& velocity) const;
  static constexpr double kNoFilm_mm = 1e30;

  [[nodiscard]] const FilmMesh& mesh() const { return film_->mesh; }
  [[nodiscard]] const std::vector<Eigen::Vector2d>& nodes() const { return nodes_; }

 private:
  [[nodiscard]] Eigen::Vector2d value(const Locator::Place& place) const;

  struct Film {
    FilmMesh mesh;
    Locator locator;
  };
  static std::shared_ptr<const Film> no_film();

  std::shared_ptr<const Film> film_ = no_film();
  std::vector<Eigen::Vector2d> nodes_;
};

/// Dirichlet values of eq. (1) for every node: zero at the vat, the pull at the waterline (at a
/// corner the mean of its two sides), NaN for inner nodes.
[[nodiscard]] std::vector<Eigen::Vector2d> boundary_velocities(const FilmMesh& mesh,
                                                               const waterline::PullIndex& pulls);

/// Stokes flow (section 4.2, eq. 2): each component harmonic, quadratic elements, one
/// factorisation for both.
/// @param fixed  per node the prescribed velocity, NaN where it is to be found
/// @return per node the velocity; kInternal if the matrix cannot be factored
[[nodiscard]] Result<std::vector<Eigen::Vector2d>> solve_stokes(
    const FilmMesh& mesh, const std::vector<Eigen::Vector2d>& fixed);

}  // namespace hydroprint::velocity
