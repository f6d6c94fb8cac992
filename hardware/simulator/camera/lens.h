#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace hydroprint::simulated_camera {

/// Frame size, frame rate and depth range of a first-generation Kinect.
inline constexpr int kWidth_px = 640;
inline constexpr int kHeight_px = 480;
inline constexpr int kRate_hz = 30;
inline constexpr int kLeast_mm = 400;
inline constexpr int kMost_mm = 4000;

/// The manufacturer's focal length (which implies the fields of view, 58.1 by 45.3 degrees) and the
/// distance of the projector from the camera, along +x (Konolige and Mihelich, Technical
/// description of Kinect calibration, ROS, 2011: 580 px and 75 mm).
inline constexpr double kFocal_px = 575.8;
inline constexpr double kBaseline_mm = 75;
[[nodiscard]] double horizontal_fov_rad();
[[nodiscard]] double vertical_fov_rad();

/// The projection model of a camera. A point (X, Y, Z) of camera coordinates, with x = X / Z, y = Y
/// / Z, r² = x² + y², is projected to centre + focal (x_d, y_d) with Brown's
///   x_d = x (1 + k1 r² + k2 r⁴) + 2 p1 x y + p2 (r² + 2 x²)
///   y_d = y (1 + k1 r² + k2 r⁴) + p1 (r² + 2 y²) + 2 p2 x y
/// in pixels whose centres are at whole numbers. The reported depth is Z times depth_scale.
struct Lens {
  double focal_px = kFocal_px;
  Eigen::Vector2d centre_px{(kWidth_px - 1) / 2.0, (kHeight_px - 1) / 2.0};
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0;
  double depth_scale = 1;
};

/// Draws the lens of a random camera. The lens deviates from the manufacturer's values as much as
/// published calibrations do.
[[nodiscard]] Lens drawn_lens(std::uint64_t seed);

/// Returns the pixel of a direction (x, y, 1).
[[nodiscard]] Eigen::Vector2d project(const Lens& lens, const Eigen::Vector2d& direction);

/// Returns the direction of a pixel: the inverse of project(), to 1e-12.
[[nodiscard]] Eigen::Vector2d unproject(const Lens& lens, const Eigen::Vector2d& pixel);

}  // namespace hydroprint::simulated_camera
