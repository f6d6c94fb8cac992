#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "sim/scan/camera.h"
#include "sim/scan/tracking.h"

namespace hydroprint::scan {

/// Where the frames of a camera swept by hand were taken. Frame W: the camera's at the first frame.
struct Path {
  std::vector<Pose> X_WC;       ///< per frame
  std::vector<bool> is_placed;  ///< false: lost; its pose is that of the one before it
  double rms_mm = 0;            ///< of smoothed frames from what those before them show, along rays

  [[nodiscard]] std::size_t lost() const {
    return static_cast<std::size_t>(std::count(is_placed.begin(), is_placed.end(), false));
  }
};

/// What such a camera saw, frame W.
struct Sweep {
  Volume volume;
  Path path;
  std::size_t fused = 0;  ///< frames that made the volume
};

/// What fuse_sweep() is told.
struct SweepTask {
  std::span<const DepthFrame> frames;
  std::span<const double> times_s;  ///< of the frames, rising
  Camera camera;
  DepthNoise noise;
  Volume::Options volume;
};

/// Frames of a camera in motion as one volume. Each frame is placed by what the frames before it
/// show (frame to model, KinectFusion, Izadi et al. 2011), smoothed; then every third is fused as
/// it is. What is known of the camera's fixed pattern is taken off all of them. Refuses what
/// check_frames refuses, and (kInvalidArgument) frames that are not of the lens's size or have
/// other times; with kFailedPrecondition and a reason: CAMERA_BLACK where the first frame has
/// hardly a depth, CAMERA_LOST where ten frames on end find no place.
[[nodiscard]] Result<Sweep> fuse_sweep(const SweepTask& task, const Context& context);

}  // namespace hydroprint::scan
