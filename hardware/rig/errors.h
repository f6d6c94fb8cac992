#pragma once

#include "hardware/rig/state.h"
#include "sim/base/result.h"

namespace hydroprint::rig {

/// Error for a refused command: the reason and the first remedy, with metadata `state` and, if set,
/// `cause`. Never kUnavailable, because clients must not repeat these commands automatically.
[[nodiscard]] Error refused(Refusal refusal, const Condition& condition);

/// Error of a motion that failed for this cause: fault and remedy, with metadata `cause`.
[[nodiscard]] Error failed(Cause cause);

}  // namespace hydroprint::rig
