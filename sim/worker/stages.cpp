#include "sim/worker/stages.h"

#include "sim/worker/calibrate.h"
#include "sim/worker/fit.h"
#include "sim/worker/fuse.h"
#include "sim/worker/print_image.h"
#include "sim/worker/template.h"
#include "sim/worker/validate.h"

namespace hydroprint::worker {
namespace {

void append(std::vector<Stage>& stages, const std::vector<Stage>& more) {
  stages.insert(stages.end(), more.begin(), more.end());
}

}  // namespace

// Weights: about the percent that the dips of a globe and of a cow took with the default flags;
// with inertia, the sheet takes some three times as long (sim/sheet/README.md).
std::vector<Stage> stages(const Options& options) {
  if (options.verb == Verb::kValidate) return validation_stages(options);
  if (options.verb == Verb::kFit) return fit_stages();
  if (options.verb == Verb::kPrintImage) return print_image_stages();
  if (options.verb == Verb::kTemplate) return template_stages();
  if (options.verb == Verb::kCalibrate) return calibrate_stages();
  if (options.verb == Verb::kCalibrateCamera) return calibrate_camera_stages();
  if (options.verb == Verb::kFuse) return fuse_stages();
  const bool is_sheet = options.film_model == pipeline::FilmModel::kSheet;
  const bool is_simulation = options.verb == Verb::kSimulate;
  const int passes = is_sheet && options.ink_image.empty() ? options.ink_passes : 0;
  const Stage ink{"ink", 0.5};
  const Stage sheet{"sheet", options.inertia ? 90.0 : 30.0};

  std::vector<Stage> out = {{"inputs", 0.5}};
  if (!options.ink_image.empty()) out.push_back(ink);
  out.push_back({"reading", 4});
  if (!is_simulation && passes > 0) out.push_back(ink);
  append(out, {{"surface", 1}, {"waterline", 1}, {"velocity", 9}});
  if (is_simulation && passes > 0) {
    for (int pass = 0; pass < passes; ++pass) {
      append(out, {{"flow map", 10}, {"film image", 1}, ink, sheet});
    }
  } else if (is_sheet) {
    out.push_back(sheet);
  }
  out.push_back({"flow map", 15});
  if (!options.map_only) {
    if (is_simulation) out.push_back({"film image", 7});
    out.push_back({"pictures", 20});
  }
  out.push_back({"writing", 4});
  return out;
}

}  // namespace hydroprint::worker
