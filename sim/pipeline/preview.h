#pragma once

#include "sim/pipeline/pipeline.h"

namespace hydroprint::pipeline {

/// Returns options for a coarse version of the dip, fast enough for a page on which the user turns
/// the object. It uses Stokes flow on the model's own triangles, with a film mesh and steps just
/// fine enough to show the film's landing (to a millimetre on the film up to theta = 120 degrees).
/// The stretch is less accurate: up to 50 % off near the end of the dip. Effects of the sheet and
/// its ink are not modelled.
[[nodiscard]] DipOptions preview_of(DipOptions options);

}  // namespace hydroprint::pipeline
