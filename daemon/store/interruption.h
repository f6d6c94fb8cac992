#pragma once

#include "daemon/store/job_changes.h"

namespace hydroprint::daemon {

/// Why running jobs are interrupted: the daemon shut down; it was lost (it was killed, or the
/// machine crashed), in which case the next daemon finds them running; or the worker was lost while
/// the daemon ran.
enum class Interruption { kShutdown, kLoss, kWorkerLoss };

/// Interrupts an open job: CANCELLING -> CANCELLED; a computed job that is RUNNING -> INTERRUPTED
/// -> QUEUED, or FAILED after the third loss; another job -> INTERRUPTED. Closes its execution.
/// Call this within a transaction.
[[nodiscard]] Status interrupt_open(JobChanges& changes, const Job& job, Interruption why);

}  // namespace hydroprint::daemon
