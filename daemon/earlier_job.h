#pragma once

#include <string>

#include "daemon/job_store.h"
#include "daemon/layout.h"

namespace hydroprint::daemon {

/// The job that another one goes on from.
/// @param name   "jobs/7"
/// @param verb   what it has to be
/// @param field  of the spec that names it, for what is refused
/// @return ID_INVALID, JOB_NOT_FOUND; SPEC_INVALID if it is of another kind; STATE_FORBIDS if it
/// did
///   not succeed
[[nodiscard]] Result<Job> earlier_job(const std::string& name, const std::string& verb,
                                      const std::string& field, JobStore& jobs);

/// Its report.json.
/// @return kFailedPrecondition, STATE_FORBIDS if that cannot be used
[[nodiscard]] Result<std::string> report_of(const Job& job, const Layout& layout);

}  // namespace hydroprint::daemon
