#pragma once

#include <span>

#include "sim/base/context.h"
#include "sim/mesh/surface.h"
#include "sim/scan/camera.h"
#include "sim/scan/fusion.h"

namespace hydroprint::registration {

/// A camera calibrated with views of a board.
struct CameraCalibration : scan::Camera {
  double rms_mm = 0;      ///< rms distance of the scanned points from the board, along its normals
  double rms_sigmas = 0;  ///< the same distance in units of the noise
  std::size_t views = 0;  ///< number of views in which the board was found
};

/// Finds the lens and the depth scale for which a board of known shape has this shape in every
/// view, by least squares over the lens and the board's poses in all views together. Uses one point
/// per patch of constant noise. This noise is assumed to be the same in every view, and is
/// estimated together with the lens.
/// Fails (kFailedPrecondition, POOR_VIEWS) with a message on how to improve the views. The views
/// must show the board at least five times, cover 60 % of the image, and differ by 25 degrees in
/// tilt and by 15 % in distance. Residuals must be within twice the noise. The standard error of
/// every parameter must be below a third of its prior standard deviation.
/// @param views    each shows the whole board (such as calibration_board()), more than 30 mm in
///                 front of the background, with nothing else touching it in the image
/// @param nominal  prior, with these standard deviations: a tenth of the focal length, 15 pixels
///                 for the image centre, 0.3 and 1 for radial and 0.01 for tangential distortion,
///                 and a twentieth of the scale
[[nodiscard]] Result<CameraCalibration> calibrate_camera(std::span<const scan::FusedFrame> views,
                                                         const mesh::Surface& board,
                                                         const scan::Lens& nominal,
                                                         const scan::DepthNoise& noise,
                                                         const Context& context);

}  // namespace hydroprint::registration
