#pragma once

#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/worker/options.h"
#include "sim/worker/out_folder.h"
#include "sim/worker/progress.h"
#include "sim/worker/report.h"

namespace hydroprint::worker {

[[nodiscard]] std::vector<Stage> print_image_stages();

/// Puts the film image on paper, writes print.pdf, print.png or print-N.png and print.tif or
/// print-N.tif as asked for, and fills in what report.json is to tell.
[[nodiscard]] Status run_print_image(const Options& options, OutFolder& folder, Report& report,
                                     const Context& context);

}  // namespace hydroprint::worker
