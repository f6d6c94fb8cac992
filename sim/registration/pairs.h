#pragma once

#include <span>
#include <vector>

#include "sim/base/context.h"
#include "sim/registration/shape.h"
#include "sim/registration/twist.h"
#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// A scan point and the plane of the surface that it should lie on; camera frame.
struct Pair {
  const scan::ScanPoint* scan = nullptr;
  Eigen::Vector3d on_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double residual_mm = 0;        ///< of the point, outward
  double changing_sigma_mm = 0;  ///< along the normal, as the constant one
  double constant_sigma_mm = 0;
  double usual_constant_mm = 0;  ///< the same where nothing is known of the camera's pattern

  [[nodiscard]] double sigma_mm() const;
  /// What it would be if nothing were known of the camera's pattern.
  [[nodiscard]] double usual_sigma_mm() const;
  /// Without what is constant.
  [[nodiscard]] double own_sigma_mm() const;
};

/// Which point of the surface a scan point is paired with.
enum class Pairing {
  kNearest,  ///< finds its way from far, but takes the nearer side of a crease, whatever is true
  kOnRay,    ///< where the pixel's ray meets the surface: depths err along rays
};

/// Pairs points with the surface, where that is within `reach_mm`, looks the way the scan says, and
/// is seen by the camera at no grazing angle.
[[nodiscard]] Result<std::vector<Pair>> pair_up(const Shape& shape,
                                                std::span<const scan::ScanPoint> points,
                                                const Pose& X_CB, Pairing pairing, double reach_mm,
                                                const Context& context);

/// Motion in units of mm of surface: turns times a length, then shifts.
struct Normals {
  Matrix6 information = Matrix6::Zero();  ///< sum of weight times direction squared
  Matrix6 scatter = Matrix6::Zero();      ///< covariance of `pull` by noise
  Vector6 pull = Vector6::Zero();
  CameraGain camera;  ///< derivative of `pull` by the camera's unknowns; by none at first
};

/// How the surface's distance along the pair's normal goes with its motion about `centre`.
[[nodiscard]] Vector6 direction(const Pair& pair, const Eigen::Vector3d& centre, double length_mm);

/// The normal equations of the pairs.
/// @param weights  robust ones, in [0, 1]
[[nodiscard]] Normals normal_equations(std::span<const Pair> pairs, std::span<const double> weights,
                                       const Eigen::Vector3d& centre, double length_mm);

/// Adds derivatives by what is not known of the camera.
void add_camera(Normals& normals, std::span<const Pair> pairs, std::span<const double> weights,
                const Eigen::Vector3d& centre, double length_mm, const scan::Camera& camera);

}  // namespace hydroprint::registration
