#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "sim/scan/frame.h"

namespace hydroprint::scan {

/// The depths that a structured-light camera can tell at all. It measures disparity in steps, so
/// they are scale_mm / (n + shift) with whole n; what it reports is the nearest whole mm. Where
/// steps are longer than 1 mm, that rounding can be taken back; where they are shorter, on average.
struct DepthSteps {
  double scale_mm = 0;           ///< focal length times baseline over the disparity's step
  double shift = 0;              ///< in [0, 1)
  std::vector<float> before_mm;  ///< by reported depth: before it was rounded; the mean if several
                                 ///< steps are rounded to it, that itself if none is

  /// @param reported_mm  above 0
  [[nodiscard]] float before_rounding_mm(float reported_mm) const;
};

/// How often which depth was reported.
struct DepthCounts {
  bool are_whole = true;           ///< no depth was told but in whole mm
  std::vector<std::size_t> of_mm;  ///< by depth

  void add(std::span<const DepthFrame> frames);
};

/// The steps that explain every depth reported often enough, to within half a mm:
/// only the true ones leave out all depths that never occur. A first-generation Kinect's, with up
/// to 5 % another scale (Konolige and Mihelich, Technical description of Kinect calibration, 2011).
/// Rounding depends on depth alone, so neither time nor neighbours take it out of a mean, and where
/// steps are nearly whole mm long it is the same over several cm.
/// @return nothing where depths are not whole mm, are too few to tell, or do not come in such steps
[[nodiscard]] std::optional<DepthSteps> find_depth_steps(const DepthCounts& counts);
[[nodiscard]] std::optional<DepthSteps> find_depth_steps(std::span<const DepthFrame> frames);

}  // namespace hydroprint::scan
