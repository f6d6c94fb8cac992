#pragma once

#include <optional>
#include <span>

#include "sim/calibrate/layout_file.h"
#include "sim/registration/camera/calibrate_camera.h"
#include "sim/scan/sweep.h"

namespace hydroprint::calibrate {

/// Input of fuse_swept().
struct SweptTask {
  std::span<const scan::DepthFrame> frames;  ///< frames of a camera swept by hand
  std::span<const double> times_s;
  registration::CameraCalibration camera;
  std::optional<RigLayout> layout;  ///< nullopt: no markers
  scan::Volume::Options volume;
};

/// The result of a sweep. It is in the film frame, or without a layout in the camera frame of the
/// first depth frame.
struct SweptScan {
  scan::TriangleMesh mesh;
  scan::Path path;                                    ///< path of the camera, in the mesh's frame
  std::optional<registration::FilmFrame> film_frame;  ///< as seen in the first depth frame
  Warnings warnings;
};

/// Fuses the frames of a hand-swept camera into a surface. Keeps everything within 1.5 m of the
/// camera or, with a layout, everything within the bars. The markers have to be in view in the
/// first frame. Returns the errors of scan::fuse_sweep and find_film_frame, and kFailedPrecondition
/// (NO_SURFACE) if no surface was seen often enough.
[[nodiscard]] Result<SweptScan> fuse_swept(const SweptTask& task, const Context& context);

}  // namespace hydroprint::calibrate
