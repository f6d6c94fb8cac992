#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sim/base/result.h"
#include "sim/velocity/film_mesh.h"
#include "sim/velocity/locator.h"
#include "sim/waterline/pull_index.h"

namespace hydroprint::velocity {

/// Film velocity at one immersion, per unit of dip speed. It is quadratic on the triangles of the
/// film mesh.
class VelocityField {
 public:
  /// Creates a field without film.
  VelocityField() = default;
  VelocityField(FilmMesh mesh, std::vector<Eigen::Vector2d> nodes);

  /// Returns a field with other velocities that shares the film mesh.
  [[nodiscard]] VelocityField with(std::vector<Eigen::Vector2d> nodes) const;

  /// Computes the velocity at a point of the film. For a point up to `reach_mm` outside, uses the
  /// nearest point of the film.
  /// @param triangle  the triangle to try first (-1: unknown); set to the triangle found
  /// @return false, without changing `velocity`, if there is no film within reach
  [[nodiscard]] bool at(const Eigen::Vector2d& point_mm, double reach_mm, Eigen::Vector2d& velocity,
                        int& triangle) const;
  [[nodiscard]] bool at(const Eigen::Vector2d& point_mm, double reach_mm,
                        Eigen::Vector2d& velocity) const;

  /// Computes the velocity at the nearest point of the film; zero if the film is beyond the
  /// locator's reach.
  /// @return distance of the point from the film, mm; kNoFilm_mm if beyond reach
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

/// Returns the Dirichlet values of eq. (1) for all nodes: zero at the vat, the pull at the
/// waterline (at a corner, the mean of its two sides) and NaN for inner nodes.
[[nodiscard]] std::vector<Eigen::Vector2d> boundary_velocities(const FilmMesh& mesh,
                                                               const waterline::PullIndex& pulls);

/// Solves for the Stokes flow (section 4.2, eq. 2). Each velocity component is harmonic. The two
/// components share one factorisation, on quadratic elements.
/// @param fixed  for each node, the prescribed velocity, or NaN where it is unknown
/// @return the velocity of each node; kInternal if the matrix cannot be factored
[[nodiscard]] Result<std::vector<Eigen::Vector2d>> solve_stokes(
    const FilmMesh& mesh, const std::vector<Eigen::Vector2d>& fixed);

}  // namespace hydroprint::velocity
