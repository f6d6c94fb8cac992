#pragma once

#include <cstdint>

#include "daemon/store/database/database.h"

namespace hydroprint::daemon {

// How long jobs, assets, uploads and audit entries are kept is counted by the machine's clock,
// which may be set wrong for a while. So only time that is credible counts: what passes between two
// looks at the clock, if it is at most a day. Where the clock moved further, or back, all deadlines
// move with it, and nothing is deleted for it. A daemon that was off for longer than a day
// therefore keeps things that much longer.

/// Looks at the clock: moves the deadlines of jobs, assets and uploads with it if it jumped since
/// the last look. To be called before anything is deleted for its age.
/// @return by how far it jumped, ms; 0 if it did not
[[nodiscard]] Result<std::int64_t> follow_clock(Database& database, std::int64_t now_ms);

/// The time by which the age of records with a fixed time (the audit log) is counted: `now_ms` less
/// all jumps so far.
[[nodiscard]] Result<std::int64_t> credible_time_ms(Database& database, std::int64_t now_ms);

}  // namespace hydroprint::daemon
