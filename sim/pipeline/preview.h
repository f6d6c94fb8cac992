#pragma once

#include "sim/pipeline/pipeline.h"

namespace hydroprint::pipeline {

/// The same dip, roughly, for a page that answers while an object is being turned: Stokes flow, a
/// film mesh and steps that are just fine enough to show where film goes (to a millimetre on the
/// film up to theta = 120 degrees), on the model's own triangles. How far it is stretched is told
/// less well, by half near the end of the dip; what the sheet and its ink do, not at all.
[[nodiscard]] DipOptions preview_of(DipOptions options);

}  // namespace hydroprint::pipeline
