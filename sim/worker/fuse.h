#pragma once

#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/worker/options.h"
#include "sim/worker/out_folder.h"
#include "sim/worker/progress.h"
#include "sim/worker/report.h"

namespace hydroprint::worker {

[[nodiscard]] std::vector<Stage> fuse_stages();

/// Fuses the frames of a camera swept by hand, writes scan.ply, scan.png and camera_path.csv, and
/// fills in what report.json is to tell.
[[nodiscard]] Status run_fuse(const Options& options, OutFolder& folder, Report& report,
                              const Context& context);

}  // namespace hydroprint::worker
