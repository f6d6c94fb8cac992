#pragma once

#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/pipeline/pipeline.h"
#include "sim/worker/options.h"
#include "sim/worker/out_folder.h"
#include "sim/worker/progress.h"
#include "sim/worker/report.h"

namespace hydroprint::worker {

[[nodiscard]] std::vector<Stage> template_stages();

/// Draws the placement template, writes placement.pdf, and fills in what report.json is to tell.
/// @param dip  pose and film
[[nodiscard]] Status run_template(const Options& options, const pipeline::DipOptions& dip,
                                  OutFolder& folder, Report& report, const Context& context);

}  // namespace hydroprint::worker
