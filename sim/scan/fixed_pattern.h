#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/base/result.h"
#include "sim/scan/noise.h"

namespace hydroprint::scan {

/// What is known of the part of a camera's noise that is the same in every frame: per square of
/// pixels, row after row from the top left, in units of DepthNoise::constant_sigma_mm() at the
/// depth that is seen. (So the pattern is one over the image, and grows with depth as the noise
/// does. Real Kinects' is one in disparity, times a function of disparity: Herrera, Kannala and
/// Heikkilä, Joint depth and color camera calibration with distortion correction, IEEE TPAMI 34,
/// 2012.)
struct FixedPattern {
  int width_px = 0;  ///< of the image; 0: nothing is known
  int height_px = 0;
  int patch_px = 0;
  std::vector<float> offset = {};  ///< that the reported depth has too much
  std::vector<float> sigma = {};   ///< of its error that it has for itself alone
  /// What offsets have in common with each other, and with the lens, as both are of the same views:
  /// derivative by unknowns that are independent, of mean 0 and standard deviation 1. The first
  /// nine are those of the lens (Camera::covariance). A row an unknown, a column a patch, in steps.
  Eigen::Matrix<std::int8_t, Eigen::Dynamic, Eigen::Dynamic> shared = {};
  Eigen::VectorXf step = {};  ///< per unknown

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

  /// A reported depth without what is known to be too much; as it is where nothing is known.
  [[nodiscard]] double taken_off_mm(int u, int v, double reported_mm,
                                    const DepthNoise& noise) const;
  /// Standard deviation of what is left, in units of the constant noise; 1 where nothing is known.
  [[nodiscard]] double left(int u, int v) const { return is_known() ? sigma[patch_at(u, v)] : 1; }

  /// Refuses (kInvalidArgument) one that is known, but for other images or squares.
  [[nodiscard]] Status check_for(int image_width_px, int image_height_px,
                                 const DepthNoise& noise) const;

  /// Sets `shared` and `step`, rounded to 1/127 of the most of each unknown.
  void set_shared(const Eigen::MatrixXd& derivatives);
};

}  // namespace hydroprint::scan
