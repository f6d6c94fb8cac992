#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Draws the object's position over the film, for a rig without a camera. Writes placement.pdf.
[[nodiscard]] Verb template_verb();

}  // namespace hydroprint::worker
