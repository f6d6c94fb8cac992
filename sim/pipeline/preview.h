#pragma once

#include "sim/pipeline/pipeline.h"

namespace hydroprint::pipeline {

/// A coarse version of the dip, for a page that responds while the user turns an object. It uses
/// Stokes flow on the model's own triangles, with film mesh and steps just fine enough to show the
/// film's landing (to a millimetre on the film up to theta = 120 degrees). The stretch is less
/// accurate, by half near the end of the dip. Effects of the sheet and its ink are missing.
[[nodiscard]] DipOptions preview_of(DipOptions options);

}  // namespace hydroprint::pipeline
