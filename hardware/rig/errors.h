#pragma once

#include "hardware/rig/state.h"
#include "sim/base/result.h"

namespace hydroprint::rig {

/// What a refused command answers: why, and what to do first; metadata `state` and, if there is
/// one, `cause`. Never kUnavailable: nothing here is to be tried again blindly.
[[nodiscard]] Error refused(Refusal refusal, const Condition& condition);

/// What a motion that failed for this cause says: what happened and what to do; metadata `cause`.
[[nodiscard]] Error failed(Cause cause);

}  // namespace hydroprint::rig
