#pragma once

#include <span>

#include "sim/base/context.h"
#include "sim/mesh/surface.h"
#include "sim/scan/camera.h"
#include "sim/scan/fusion.h"

namespace hydroprint::registration {

/// A camera as views of a board tell it.
struct CameraCalibration : scan::Camera {
  double rms_mm = 0;      ///< of the board's points from the board, along its normals
  double rms_sigmas = 0;  ///< the same in units of what noise explains
  std::size_t views = 0;  ///< in which the board was found
};

/// Lens and depth scale for which a board of known shape has its shape in every view: least squares
/// over the lens and the board's pose in each view together. One point a patch of constant noise is
/// used; that noise is taken to be the same in every view, and comes out with the lens.
/// @param views    each of a board (calibration_board(), say) that nothing else touches in the
///                 image, more than 30 mm before what is behind it, seen whole
/// @param nominal  believed to a tenth in focal length, 15 pixels in the middle, 0.3 and 1 in
/// radial and
///                 0.01 in tangential distortion, and a twentieth in scale
/// Refuses (kFailedPrecondition, POOR_VIEWS), with what to add: fewer than five views with the
/// board in them; the image covered by less than 60 %; all views less than 25 degrees apart in
/// tilt; distances within 15 %; residuals beyond twice the noise; a parameter that the views tell
/// no better than to a third of what was believed.
[[nodiscard]] Result<CameraCalibration> calibrate_camera(std::span<const scan::FusedFrame> views,
                                                         const mesh::Surface& board,
                                                         const scan::Lens& nominal,
                                                         const scan::DepthNoise& noise,
                                                         const Context& context);

}  // namespace hydroprint::registration
