#pragma once

#include <string>

#include "daemon/jobs/kind.h"
#include "daemon/jobs/plan_progress.h"

namespace hydroprint::daemon {

/// Reads a plan and the later jobs that may belong to it: all dips and captures, and of the other
/// jobs only those of the plan's owner and of the caller. Errors: those of earlier_plan().
[[nodiscard]] Result<PlanFacts> plan_facts(const std::string& plan_job, const std::string& caller,
                                           const JobSources& sources);

}  // namespace hydroprint::daemon
