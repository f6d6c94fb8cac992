#pragma once

#include <Eigen/Core>
#include <vector>

namespace hydroprint::scan {

/// The lens model of a depth camera. Camera frame C: origin in the centre of projection, x to the
/// right and y down in the image, z along the optical axis. A point at (x, y) = (X/Z, Y/Z), with
/// r2 = x^2 + y^2, is seen at pixel (cx + fx x_d, cy + fy y_d), with Brown's distortion
///   x_d = x (1 + k1 r2 + k2 r2^2) + 2 p1 x y + p2 (r2 + 2 x^2)
///   y_d = y (1 + k1 r2 + k2 r2^2) + p1 (r2 + 2 y^2) + 2 p2 x y.
/// Pixel centres are at whole numbers. The depth Z is depth_scale times the reported depth, without
/// an offset, because triangulated depth counts from the centre of projection.
struct Lens {
  static constexpr int kParameters = 9;
  using Vector = Eigen::Matrix<double, kParameters, 1>;
  using Matrix = Eigen::Matrix<double, kParameters, kParameters>;

  int width_px = 640;
  int height_px = 480;
  double fx_px = 575.8;  ///< nominal value in the drivers of first-generation Kinects
  double fy_px = 575.8;
  double cx_px = 319.5;
  double cy_px = 239.5;
  double k1 = 0;
  double k2 = 0;
  double p1 = 0;
  double p2 = 0;
  double depth_scale = 1;

  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& p_C) const;
  /// Returns the point at depth 1 on a pixel's ray.
  [[nodiscard]] Eigen::Vector3d ray(double u, double v) const;
  /// Returns ray() of every pixel, row by row.
  [[nodiscard]] std::vector<Eigen::Vector3d> rays() const;
  [[nodiscard]] double true_depth_mm(double reported_mm) const { return depth_scale * reported_mm; }
  /// Returns the point seen by a pixel with this reported depth.
  [[nodiscard]] Eigen::Vector3d point(double u, double v, double reported_mm) const {
    return ray(u, v) * true_depth_mm(reported_mm);
  }

  /// Returns fx, fy, cx, cy, k1, k2, p1, p2 and depth_scale, in this order.
  [[nodiscard]] Vector parameters() const;
  [[nodiscard]] Lens with(const Vector& parameters) const;
  /// Returns the derivatives of point() with respect to the parameters, from central differences.
  [[nodiscard]] Eigen::Matrix<double, 3, kParameters> derivatives(double u, double v,
                                                                  double reported_mm) const;
};

}  // namespace hydroprint::scan
