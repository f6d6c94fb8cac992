#pragma once

#include <cstdint>

#include "daemon/store/database/database.h"

namespace hydroprint::daemon {

// Retention of jobs, assets, uploads and audit entries uses the machine's clock, which may be wrong
// for a while. So only credible time counts: an interval between two readings of at most a day. If
// the clock moved further, or backwards, all deadlines move with it and nothing is deleted early. A
// daemon that was off for longer than a day therefore keeps data that much longer.

/// Reads the clock, and moves the deadlines of jobs, assets and uploads if it jumped since the last
/// call. Call this before deleting anything for its age.
/// @return the jump in ms; 0 if there was none
[[nodiscard]] Result<std::int64_t> follow_clock(Database& database, std::int64_t now_ms);

/// The time for records with a fixed time (the audit log): `now_ms` minus all jumps so far.
[[nodiscard]] Result<std::int64_t> credible_time_ms(Database& database, std::int64_t now_ms);

}  // namespace hydroprint::daemon
