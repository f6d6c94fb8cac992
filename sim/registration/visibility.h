#pragma once

#include <span>
#include <vector>

#include "sim/registration/shape.h"
#include "sim/scan/cloud.h"
#include "sim/scan/frame.h"

namespace hydroprint::registration {

/// A comparison of the camera's depths with the expected surface. The fractions add up to 1.
struct Sight {
  std::size_t expected = 0;  ///< samples that the surface itself does not hide
  double on = 0;             ///< fraction of samples with a depth on the surface
  double before = 0;         ///< fraction where the camera sees something nearer
  /// Fraction where the camera sees something farther: there is no surface there.
  double through = 0;
  double without_depth = 0;  ///< fraction without a depth
  double out_of_view = 0;    ///< fraction outside the image
};

/// Returns samples of a body that its own surface does not hide from the camera; camera frame.
[[nodiscard]] std::vector<SurfacePoint> visible(const Shape& shape, const Pose& X_CB,
                                                std::size_t samples);

/// Compares samples with depths.
/// @param depth         mean depths as reported by the camera
/// @param tolerance_mm  along the optical axis
[[nodiscard]] Sight look_at(std::span<const SurfacePoint> visible_C, const scan::DepthFrame& depth,
                            const scan::Lens& lens, double tolerance_mm);

}  // namespace hydroprint::registration
