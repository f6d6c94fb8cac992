#pragma once

#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/worker/options.h"
#include "sim/worker/out_folder.h"
#include "sim/worker/progress.h"
#include "sim/worker/report.h"

namespace hydroprint::worker {

/// The experiments that were asked for, then writing.
[[nodiscard]] std::vector<Stage> validation_stages(const Options& options);

/// Runs the experiments, writes their pictures as they come and then report.html, and fills in
/// what report.json is to tell.
[[nodiscard]] Status run_validate(const Options& options, OutFolder& folder, Report& report,
                                  const Context& context);

}  // namespace hydroprint::worker
