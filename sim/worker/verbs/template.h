#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Draws where the object belongs over the film: placement.pdf.
[[nodiscard]] Verb template_verb();

}  // namespace hydroprint::worker
