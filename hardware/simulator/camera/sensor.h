#pragma once

#include <cstdint>
#include <vector>

#include "hardware/simulator/camera/lens.h"

namespace hydroprint::simulated_camera {

/// What the light brings to each pixel: depth along the camera's axis in mm, row by row; 0 where
/// there is nothing to measure (nothing there, not reached by the projector, seen too flat).
using Depths = std::vector<float>;

/// A frame as a camera tells it: mm, row by row; 0: not measured.
using Frame = std::vector<std::uint16_t>;

/// Which of its errors a sensor has, besides its lens.
struct Errors {
  bool noise = true;
  bool steps = true;  ///< disparity in steps of 1/8 pixel
  bool gaps = true;   ///< pixels missing at edges
};

/// Standard deviation of a first-generation Kinect's depth noise along its axis: 1.2 + 1.9 (z -
/// 0.4)² mm, z in m (Nguyen, Izadi and Lovell, Modeling Kinect sensor noise for improved 3D
/// reconstruction and tracking, 3DIMPVT 2012, for surfaces that face the camera).
[[nodiscard]] double noise_sigma_mm(double depth_mm);

/// Half of the noise's variance does not change with time, the same over patches of so many pixels
/// squared: no averaging removes it.
inline constexpr int kPatch_px = 4;
inline constexpr double kConstantShare = 0.5;

/// That constant part, in its standard deviations: per patch, row by row from the top left.
[[nodiscard]] std::vector<float> constant_noise(std::uint64_t seed);

/// The disparity, f b / z, comes in steps of this many pixels (Konolige and Mihelich, 2011).
inline constexpr double kDisparityStep_px = 0.125;

/// What the sensor makes of it. The same arguments give the same bits.
[[nodiscard]] Frame sense(const Depths& depths, double depth_scale, const Errors& errors,
                          std::uint64_t seed, double time_s);

}  // namespace hydroprint::simulated_camera
