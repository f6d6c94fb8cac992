#pragma once

#include <cstdint>
#include <vector>

#include "hardware/simulator/camera/lens.h"

namespace hydroprint::simulated_camera {

/// Depths of the pixels along the optical axis in mm, row by row. 0 where nothing can be measured
/// (no surface, not lit by the projector, angle too small).
using Depths = std::vector<float>;

/// A frame in the camera's output format: mm, row by row; 0: not measured.
using Frame = std::vector<std::uint16_t>;

/// The errors of a sensor, apart from its lens.
struct Errors {
  bool noise = true;
  bool steps = true;  ///< disparity in steps of 1/8 pixel
  bool gaps = true;   ///< pixels missing at edges
};

/// Returns the standard deviation of a first-generation Kinect's depth noise along its optical
/// axis: 1.2 + 1.9 (z - 0.4)² mm, z in m (Nguyen, Izadi and Lovell, Modeling Kinect sensor noise
/// for improved 3D reconstruction and tracking, 3DIMPVT 2012, for surfaces that face the camera).
[[nodiscard]] double noise_sigma_mm(double depth_mm);

/// Half of the noise's variance (kConstantShare) is constant in time and equal within square
/// patches of side kPatch_px, so averaging over frames does not remove it.
inline constexpr int kPatch_px = 4;
inline constexpr double kConstantShare = 0.5;

/// Returns the constant part of the noise for each patch, row by row from the top left, in units of
/// its standard deviation.
[[nodiscard]] std::vector<float> constant_noise(std::uint64_t seed);

/// Step of the disparity, f b / z, in pixels (Konolige and Mihelich, 2011).
inline constexpr double kDisparityStep_px = 0.125;

/// Applies the sensor's errors. The same arguments produce bit-identical results.
/// @param number  number of the frame; determines the part of the noise that changes with time
[[nodiscard]] Frame sense(const Depths& depths, double depth_scale, const Errors& errors,
                          std::uint64_t seed, int number);

}  // namespace hydroprint::simulated_camera
