#pragma once

#include "sim/pipeline/pipeline.h"

namespace hydroprint::pipeline {

/// The same dip, roughly, for a page that answers while an object is being turned: Stokes flow, a
/// film mesh and steps that are just fine enough to show where film goes and how far it is
/// stretched (about a millimetre on the film up to theta = 120 degrees), on the model's own
/// triangles. Where the ink lands and what the sheet does to it is not for a preview to say.
[[nodiscard]] DipOptions preview_of(DipOptions options);

}  // namespace hydroprint::pipeline
