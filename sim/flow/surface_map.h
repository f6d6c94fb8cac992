#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace hydroprint::flow {

/// The film's landing as a function of the surface: one entry per point of mesh::Surface; NaN where
/// no film arrives.
struct SurfaceMap {
  std::vector<Eigen::Vector2d> film_mm;  ///< the point of the film, in F at rest, that lands here
  std::vector<double> contact_time_s;    ///< since the start of the dip
  /// Largest singular value of the film-to-surface Jacobian (section 6); see point_stretch().
  std::vector<double> stretch;
  std::vector<double> least_stretch;  ///< the smaller singular value
  /// Stated error of `film_mm`; infinite where no bound is known. Empty if none is stated.
  std::vector<double> error_mm;
};

/// A small triangle of the surface on which the map from surface to film is continuous, and linear
/// to within a tolerance (MapOptions). Together these triangles tile the part that the film
/// reaches.
struct MappedTriangle {
  std::array<Eigen::Vector2d, 3> film_mm;  ///< counter-clockwise seen from above
  int triangle = 0;                        ///< index into mesh::Surface::triangles
  /// The three corners in barycentric coordinates (corners 0, 1, 2) of the triangle with index
  /// `triangle`.
  std::array<Eigen::Vector3f, 3> barycentric;
  std::array<float, 3> contact_time_s{};
};

/// The flow map of one dip (section 4.5): per surface point, and as tiles for drawing.
struct FlowMap {
  SurfaceMap surface;
  std::vector<MappedTriangle> tiles;
  bool is_limited = false;  ///< tiles are larger than wanted, because of a limit on their number
};

}  // namespace hydroprint::flow
