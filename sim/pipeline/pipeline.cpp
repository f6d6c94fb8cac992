#include "sim/pipeline/pipeline.h"

namespace hydroprint::pipeline {

DipOptions scaled_resolution(DipOptions options, double factor) {
  options.schedule.swept_mm *= factor;
  options.mesh.size.at_waterline_mm *= factor;
  options.mesh.size.growth *= factor;
  options.mesh.size.most_mm *= factor;
  options.mesh.spacing_mm *= factor;
  options.mesh.tolerance_mm *= factor;
  options.sheet.tolerance_mm *= factor;
  if (factor < 1) options.sheet.most_sweeps += 2;
  return options;
}

}  // namespace hydroprint::pipeline
