#pragma once

#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/calibrate/frames_folder.h"
#include "sim/pipeline/pipeline.h"
#include "sim/worker/options.h"
#include "sim/worker/out_folder.h"
#include "sim/worker/progress.h"
#include "sim/worker/report.h"

namespace hydroprint::worker {

[[nodiscard]] std::vector<Stage> calibrate_stages();
[[nodiscard]] std::vector<Stage> calibrate_camera_stages();

/// Frames, and the camera that took them: of --camera, or as its driver says.
[[nodiscard]] Result<calibrate::Frames> read_scan(const Options& options,
                                                  registration::CameraCalibration& camera,
                                                  const Context& context);

/// Finds where the object hangs, writes calibration.json, pose.json, alignment.png and error.png,
/// and fills in what report.json is to tell.
/// @param dip  nominal pose and film
[[nodiscard]] Status run_calibrate(const Options& options, const pipeline::DipOptions& dip,
                                   OutFolder& folder, Report& report, const Context& context);

/// Finds a camera's lens and depth scale, writes camera.json, and fills in the same.
[[nodiscard]] Status run_calibrate_camera(const Options& options, OutFolder& folder, Report& report,
                                          const Context& context);

}  // namespace hydroprint::worker
