#include "sim/registration/symmetry.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>

namespace hydroprint::registration {
namespace {

constexpr std::size_t kTurnedSamples = 5000;
constexpr double kSameShare = 0.005;
constexpr double kNumericalNoise_mm = 1e-6;
/// No rotation of a regular polygon with up to 100 corners is a multiple of these angles.
constexpr std::array kAngles_rad = {0.037, 0.211, 0.577, 1.013, 1.618, 2.236, 2.718, 3.333};

double distance_from(const Eigen::Vector3d& axis, const Eigen::Vector3d& p) {
  return axis.cross(p).norm();
}

/// Returns whether turns about the axis through the centroid carry the samples onto the surface.
bool is_symmetric(const Shape& shape, const std::vector<SurfacePoint>& samples,
                  const Eigen::Vector3d& axis) {
  const Eigen::Vector3d& centre = shape.centroid();
  double largest_mm = 0;
  for (const SurfacePoint& s : samples)
    largest_mm = std::max(largest_mm, distance_from(axis, s.point_mm - centre));
  const double same_mm = kSameShare * largest_mm + kNumericalNoise_mm;
  for (const double angle_rad : kAngles_rad) {
    const Eigen::AngleAxisd turn(angle_rad, axis);
    for (const SurfacePoint& s : samples) {
      const Eigen::Vector3d p = centre + turn * (s.point_mm - centre);
      if ((shape.closest(p).point_mm - p).norm() > same_mm) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<Eigen::Vector3d> symmetry_axes(const Shape& shape) {
  const std::vector<SurfacePoint> samples = shape.samples(kTurnedSamples);
  // A small turn w about the centroid moves a point p along its normal n by w . (p x n).
  Eigen::Matrix3d moved = Eigen::Matrix3d::Zero();
  for (const SurfacePoint& s : samples) {
    const Eigen::Vector3d lever = (s.point_mm - shape.centroid()).cross(s.normal);
    moved += lever * lever.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moved);
  std::vector<Eigen::Vector3d> out;
  // The eigenvalues ascend. Symmetry about two axes is symmetry about all.
  for (int k = 0; k < 2; ++k) {
    if (!is_symmetric(shape, samples, solver.eigenvectors().col(k))) return out;
    out.emplace_back(solver.eigenvectors().col(k));
  }
  out.emplace_back(solver.eigenvectors().col(2));
  return out;
}

}  // namespace hydroprint::registration
