#pragma once

#include <string_view>

#include "hardware/rig/state.h"
#include "sim/base/error_reason.h"

namespace hydroprint::rig {

/// Return names that never change, for the API and records: "OFFLINE", "RIG_NOT_HOMED",
/// "LINK_LOST", "HOME".
[[nodiscard]] std::string_view name(State state);
[[nodiscard]] std::string_view name(Motion motion);
[[nodiscard]] std::string_view name(Cause cause);
[[nodiscard]] ErrorReason reason(Refusal refusal);

}  // namespace hydroprint::rig
