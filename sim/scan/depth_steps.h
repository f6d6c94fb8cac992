#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "sim/scan/frame.h"

namespace hydroprint::scan {

/// The depths that a structured-light camera can measure. It measures disparity in steps, so depths
/// are scale_mm / (n + shift) with integer n. It reports them rounded to whole mm. Where steps are
/// longer than 1 mm, the rounding can be undone exactly; where they are shorter, only on average.
struct DepthSteps {
  double scale_mm = 0;  ///< focal length times baseline, divided by the disparity step
  double shift = 0;     ///< offset of the steps, in [0, 1)
  /// The depth before rounding, indexed by reported depth. If several steps are rounded to a
  /// reported depth, it is their mean; if none is, it is the reported depth.
  std::vector<float> before_mm;

  /// @param reported_mm  above 0
  [[nodiscard]] float before_rounding_mm(float reported_mm) const;
};

/// Histogram of reported depths.
struct DepthCounts {
  bool are_whole = true;           ///< all depths are whole mm
  std::vector<std::size_t> of_mm;  ///< count for each depth in mm

  void add(std::span<const DepthFrame> frames);
};

/// Finds the steps that explain every frequently reported depth to within half a mm. Only the true
/// steps also explain why the other depths never occur. The scale is searched within 5 % of a
/// first-generation Kinect's (Konolige and Mihelich, Technical description of Kinect calibration,
/// 2011). Rounding depends only on depth, so averaging over frames or neighbours does not remove
/// its error. Where the steps are close to whole mm, the error is the same over several cm.
/// @return nullopt if depths are not whole mm, are too few, or do not fit such steps
[[nodiscard]] std::optional<DepthSteps> find_depth_steps(const DepthCounts& counts);
[[nodiscard]] std::optional<DepthSteps> find_depth_steps(std::span<const DepthFrame> frames);

}  // namespace hydroprint::scan
