#pragma once

#include <cstdint>
#include <vector>

#include "hardware/simulator/camera/lens.h"

namespace hydroprint::simulated_camera {

/// Depths of the pixels along the camera's axis in mm, row by row. 0 where nothing can be measured
/// (no surface, not lit by the projector, angle too small).
using Depths = std::vector<float>;

/// A frame as the camera delivers it: mm, row by row; 0: not measured.
using Frame = std::vector<std::uint16_t>;

/// The errors of a sensor, apart from its lens.
struct Errors {
  bool noise = true;
  bool steps = true;  ///< disparity in steps of 1/8 pixel
  bool gaps = true;   ///< pixels missing at edges
};

/// Standard deviation of a first-generation Kinect's depth noise along its axis: 1.2 + 1.9 (z -
/// 0.4)² mm, z in m (Nguyen, Izadi and Lovell, Modeling Kinect sensor noise for improved 3D
/// reconstruction and tracking, 3DIMPVT 2012, for surfaces that face the camera).
[[nodiscard]] double noise_sigma_mm(double depth_mm);

/// Half of the noise's variance is constant in time, and the same over patches of this many pixels
/// squared, so averaging does not remove it.
inline constexpr int kPatch_px = 4;
inline constexpr double kConstantShare = 0.5;

/// Returns the constant part of the noise, in units of its standard deviation: per patch, row by
/// row from the top left.
[[nodiscard]] std::vector<float> constant_noise(std::uint64_t seed);

/// Step of the disparity, f b / z, in pixels (Konolige and Mihelich, 2011).
inline constexpr double kDisparityStep_px = 0.125;

/// Applies the sensor's errors. The same arguments give bit-identical results.
[[nodiscard]] Frame sense(const Depths& depths, double depth_scale, const Errors& errors,
                          std::uint64_t seed, double time_s);

}  // namespace hydroprint::simulated_camera
