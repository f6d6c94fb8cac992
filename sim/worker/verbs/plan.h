#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Divides one picture among several dips. Writes plan.json, plan.ply and combined.png, and for
/// each dip N stretch-N.png, complete-N.png, mask-N.png and film-N.png.
[[nodiscard]] Verb plan_verb();

}  // namespace hydroprint::worker
