#pragma once

#include "hydroprint/v1/job.pb.h"

namespace hydroprint::client {

/// Whether the job's state can no longer change.
[[nodiscard]] bool is_finished(const v1::Job& job);

/// Whether every job in that state is finished. INTERRUPTED ends only dips, prints and captures.
[[nodiscard]] bool is_finished(v1::Job::State state);

}  // namespace hydroprint::client
