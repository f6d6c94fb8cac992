#pragma once

#include <cstdint>

#include "daemon/store/database/database.h"

namespace hydroprint::daemon {

// Retention of jobs, assets, uploads and audit entries uses the machine's clock, which may be wrong
// for a while. Only plausible time is therefore counted: intervals of at most a day between two
// readings. If the clock jumps further, or backwards, all deadlines are shifted by the jump and
// nothing is deleted early. A daemon that was off for longer than a day therefore keeps data that
// much longer.

/// Reads the clock, and shifts the deadlines of jobs, assets and uploads if it jumped since the
/// last call. Call this before deleting anything because of its age.
/// @return the jump in ms; 0 if there was none
[[nodiscard]] Result<std::int64_t> follow_clock(Database& database, std::int64_t now_ms);

/// Returns the time for records whose time is never shifted (the audit log): `now_ms` minus all
/// jumps so far.
[[nodiscard]] Result<std::int64_t> credible_time_ms(Database& database, std::int64_t now_ms);

}  // namespace hydroprint::daemon
