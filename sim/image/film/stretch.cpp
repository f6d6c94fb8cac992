#include "sim/image/film/stretch.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace hydroprint::image {
namespace {

double own_stretch(const mesh::Surface& surface, const flow::MappedTriangle& tile, Stretch which) {
  const auto points = tile_points(surface, tile);
  Eigen::Matrix2d film;
  film << tile.film_mm[1] - tile.film_mm[0], tile.film_mm[2] - tile.film_mm[0];
  if (film.determinant() == 0) return std::numeric_limits<double>::quiet_NaN();
  Eigen::Matrix<double, 3, 2> landed;
  landed << points[1] - points[0], points[2] - points[0];
  const Eigen::Matrix<double, 3, 2> jacobian = landed * film.inverse();
  const Eigen::Matrix2d gram = jacobian.transpose() * jacobian;
  const double mean = 0.5 * gram.trace();
  const double apart = std::hypot(0.5 * (gram(0, 0) - gram(1, 1)), gram(0, 1));
  return std::sqrt(which == Stretch::kLargest ? mean + apart : std::max(0.0, mean - apart));
}

}  // namespace

std::array<Eigen::Vector3d, 3> tile_points(const mesh::Surface& surface,
                                           const flow::MappedTriangle& tile) {
  const Eigen::Vector3i& corners = surface.triangles[tile.triangle];
  std::array<Eigen::Vector3d, 3> points;
  for (int i = 0; i < 3; ++i) {
    points[i].setZero();
    for (int k = 0; k < 3; ++k) {
      points[i] += static_cast<double>(tile.barycentric[i][k]) * surface.points[corners[k]];
    }
  }
  return points;
}

std::array<double, 3> tile_stretch(const mesh::Surface& surface, const flow::SurfaceMap& map,
                                   const flow::MappedTriangle& tile, Stretch which) {
  const std::vector<double>& values = which == Stretch::kLargest ? map.stretch : map.least_stretch;
  Eigen::Vector3d at_points;
  for (int k = 0; k < 3; ++k) at_points[k] = values[surface.triangles[tile.triangle][k]];
  std::array<double, 3> out;
  if (!at_points.allFinite()) {
    out.fill(own_stretch(surface, tile, which));
    return out;
  }
  for (int i = 0; i < 3; ++i) out[i] = at_points.dot(tile.barycentric[i].cast<double>());
  return out;
}

}  // namespace hydroprint::image
