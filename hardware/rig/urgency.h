#pragma once

namespace hydroprint::rig {

/// Asks that the calling thread goes before all that only compute (real-time priority, which its
/// children do not inherit). Where that is not permitted (RLIMIT_RTPRIO) it goes on as it is.
void go_first() noexcept;

}  // namespace hydroprint::rig
