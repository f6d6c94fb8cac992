#pragma once

#include <string>

#include "daemon/jobs/kind.h"
#include "daemon/jobs/plan_progress.h"

namespace hydroprint::daemon {

/// Collects what is known about a plan: jobs of the plan's owner and of the caller, dips of
/// anybody. Errors: those of earlier_plan().
[[nodiscard]] Result<PlanFacts> plan_facts(const std::string& plan_job, const std::string& caller,
                                           const JobSources& sources);

}  // namespace hydroprint::daemon
