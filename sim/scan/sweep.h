#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "sim/scan/camera.h"
#include "sim/scan/tracking.h"

namespace hydroprint::scan {

/// Poses of a camera swept by hand. Frame W is the camera's frame at the first depth frame.
struct Path {
  std::vector<Pose> X_WC;       ///< camera pose for each frame
  std::vector<bool> is_placed;  ///< false: not registered; the pose is that of the previous frame
  /// Rms distance, along rays, of each smoothed frame from the volume of the frames before it.
  double rms_mm = 0;

  [[nodiscard]] std::size_t lost() const {
    return static_cast<std::size_t>(std::count(is_placed.begin(), is_placed.end(), false));
  }
};

/// The fused frames of a hand-swept camera, in frame W.
struct Sweep {
  Volume volume;
  Path path;
  std::size_t fused = 0;  ///< number of frames in the volume
};

/// Input of fuse_sweep().
struct SweepTask {
  std::span<const DepthFrame> frames;
  std::span<const double> times_s;  ///< times of the frames, increasing
  Camera camera;
  DepthNoise noise;
  Volume::Options volume;
};

/// Fuses the frames of a moving camera into one volume. Each frame is smoothed and registered to
/// the frames before it (frame to model, KinectFusion, Izadi et al. 2011). Then every third frame
/// is fused without smoothing. The camera's known fixed pattern is subtracted from all frames.
/// Returns the errors of check_frames(), and kInvalidArgument if the frames' size differs from the
/// lens's or their times do not increase. Returns kFailedPrecondition with a reason: CAMERA_BLACK
/// if the first frame has hardly any depth, CAMERA_LOST if ten frames in a row cannot be
/// registered.
[[nodiscard]] Result<Sweep> fuse_sweep(const SweepTask& task, const Context& context);

}  // namespace hydroprint::scan
