#pragma once

#include <optional>
#include <span>

#include "sim/calibrate/layout_file.h"
#include "sim/registration/camera/calibrate_camera.h"
#include "sim/scan/sweep.h"

namespace hydroprint::calibrate {

/// What fuse_swept() is told.
struct SweptTask {
  std::span<const scan::DepthFrame> frames;  ///< of a camera swept by hand
  std::span<const double> times_s;
  registration::CameraCalibration camera;
  std::optional<RigLayout> layout;  ///< none: there are no markers
  scan::Volume::Options volume;
};

/// What a sweep showed, in the film frame; without a layout in that of the camera at its first
/// frame.
struct SweptScan {
  scan::TriangleMesh mesh;
  scan::Path path;                                    ///< in the mesh's frame
  std::optional<registration::FilmFrame> film_frame;  ///< as seen at the first frame
  Warnings warnings;
};

/// From frames of a camera swept by hand to the surface that they show: all that is within 1.5 m of
/// it, or with a layout what stands within the bars. The markers have to be in view at the first
/// frame.
/// Refuses what scan::fuse_sweep and find_film_frame refuse, and NO_SURFACE
/// (kFailedPrecondition) where nothing was seen often enough.
[[nodiscard]] Result<SweptScan> fuse_swept(const SweptTask& task, const Context& context);

}  // namespace hydroprint::calibrate
