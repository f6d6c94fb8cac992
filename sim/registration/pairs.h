#pragma once

#include <span>
#include <vector>

#include "sim/base/context.h"
#include "sim/registration/shape.h"
#include "sim/registration/twist.h"
#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// A scan point, and the tangent plane of the surface at its counterpart; camera frame.
struct Pair {
  const scan::ScanPoint* scan = nullptr;
  Eigen::Vector3d on_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double residual_mm = 0;        ///< residual of the point, positive outward
  double changing_sigma_mm = 0;  ///< noise that differs between frames, along the normal
  double constant_sigma_mm = 0;  ///< noise that is the same in all frames, along the normal
  double usual_constant_mm = 0;  ///< constant_sigma_mm for a camera with an unknown pattern

  [[nodiscard]] double sigma_mm() const;
  /// sigma_mm() for a camera with an unknown pattern.
  [[nodiscard]] double usual_sigma_mm() const;
  /// sigma_mm() without the constant noise.
  [[nodiscard]] double own_sigma_mm() const;
};

/// How the surface point for a scan point is chosen.
enum class Pairing {
  kNearest,  ///< nearest point: converges from far away, but is biased to the near side of a crease
  kOnRay,    ///< the point where the pixel's ray meets the surface, because depths err along rays
};

/// Pairs points with the surface. A pair requires a distance of at most `reach_mm`, similar normals
/// of surface and scan, and a viewing direction that is not grazing.
[[nodiscard]] Result<std::vector<Pair>> pair_up(const Shape& shape,
                                                std::span<const scan::ScanPoint> points,
                                                const Pose& X_CB, Pairing pairing, double reach_mm,
                                                const Context& context);

/// Normal equations for a motion of the surface in mm: rotations times a length, then translations.
struct Normals {
  Matrix6 information = Matrix6::Zero();  ///< sum of weight times direction squared
  Matrix6 scatter = Matrix6::Zero();      ///< covariance of `pull` due to noise
  Vector6 pull = Vector6::Zero();         ///< right-hand side
  /// Derivative of `pull` with respect to the camera's unknowns; set by add_camera().
  CameraGain camera;
};

/// Returns the derivative of the surface's position along the pair's normal with respect to its
/// motion about `centre`.
[[nodiscard]] Vector6 direction(const Pair& pair, const Eigen::Vector3d& centre, double length_mm);

/// Computes the normal equations of the pairs.
/// @param weights  robust weights, in [0, 1]
[[nodiscard]] Normals normal_equations(std::span<const Pair> pairs, std::span<const double> weights,
                                       const Eigen::Vector3d& centre, double length_mm);

/// Sets the derivatives with respect to the camera's unknowns.
void add_camera(Normals& normals, std::span<const Pair> pairs, std::span<const double> weights,
                const Eigen::Vector3d& centre, double length_mm, const scan::Camera& camera);

}  // namespace hydroprint::registration
