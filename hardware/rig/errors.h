#pragma once

#include "hardware/rig/state.h"
#include "sim/base/result.h"

namespace hydroprint::rig {

/// Returns the error for a refused command: the fault and its remedy, with metadata `state` and, if
/// set, `cause`. Never kUnavailable, because clients must not repeat these commands automatically.
[[nodiscard]] Error refused(Refusal refusal, const Condition& condition);

/// Returns the error for a motion that failed with this cause: fault and remedy, with metadata
/// `cause`.
[[nodiscard]] Error failed(Cause cause);

}  // namespace hydroprint::rig
