#pragma once

#include "hydroprint/v1/job.pb.h"

namespace hydroprint::client {

/// Returns whether the job's state is final.
[[nodiscard]] bool is_finished(const v1::Job& job);

/// Returns whether every job in that state is finished. INTERRUPTED is final only for dips, prints
/// and captures.
[[nodiscard]] bool is_finished(v1::Job::State state);

}  // namespace hydroprint::client
