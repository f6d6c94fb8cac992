#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/base/result.h"
#include "sim/scan/noise.h"

namespace hydroprint::scan {

/// The measured part of a camera's noise that is the same in every frame. It has a value for each
/// square of pixels, row by row from the top left, in units of DepthNoise::constant_sigma_mm() at
/// the measured depth. The pattern over the image is therefore the same at all depths, and its
/// amplitude grows with depth like the noise. (On real Kinects the pattern is one in disparity,
/// times a function of disparity: Herrera, Kannala and Heikkilä, Joint depth and color camera
/// calibration with distortion correction, IEEE TPAMI 34, 2012.)
struct FixedPattern {
  int width_px = 0;  ///< width of the image; 0: the pattern is unknown
  int height_px = 0;
  int patch_px = 0;
  std::vector<float> offset = {};  ///< reported depth minus true depth
  std::vector<float> sigma = {};   ///< standard deviation of the offset's independent error
  /// Errors that offsets share with each other and with the lens, because all are estimated from
  /// the same views. Given as derivatives with respect to independent unknowns of mean 0 and
  /// standard deviation 1. The first nine unknowns are those of the lens (Camera::covariance). One
  /// row per unknown and one column per patch, in units of `step`.
  Eigen::Matrix<std::int8_t, Eigen::Dynamic, Eigen::Dynamic> shared = {};
  Eigen::VectorXf step = {};  ///< unit of `shared` for each unknown

  [[nodiscard]] bool is_known() const { return width_px > 0; }
  [[nodiscard]] int across() const { return (width_px + patch_px - 1) / patch_px; }
  [[nodiscard]] std::size_t patches() const {
    return static_cast<std::size_t>(across()) *
           static_cast<std::size_t>((height_px + patch_px - 1) / patch_px);
  }
  [[nodiscard]] std::size_t patch_at(int u, int v) const {
    return static_cast<std::size_t>(v / patch_px) * static_cast<std::size_t>(across()) +
           static_cast<std::size_t>(u / patch_px);
  }

  /// Returns the reported depth minus the pattern's offset; unchanged if the pattern is unknown.
  [[nodiscard]] double taken_off_mm(int u, int v, double reported_mm,
                                    const DepthNoise& noise) const;
  /// Returns the standard deviation of the remaining constant noise, in units of the constant
  /// noise; 1 if the pattern is unknown.
  [[nodiscard]] double left(int u, int v) const { return is_known() ? sigma[patch_at(u, v)] : 1; }

  /// Returns kInvalidArgument if the pattern is known and has another image or patch size.
  [[nodiscard]] Status check_for(int image_width_px, int image_height_px,
                                 const DepthNoise& noise) const;

  /// Sets `shared` and `step`, rounded to 1/127 of the largest value for each unknown.
  void set_shared(const Eigen::MatrixXd& derivatives);
};

}  // namespace hydroprint::scan
