#pragma once

#include "daemon/jobs/executor.h"
#include "daemon/jobs/kind.h"

namespace hydroprint::daemon {

/// Resolves and checks a job that a client sent; proto/hydroprint/v1/spec.proto describes the
/// errors. Sets the whole request except NewJob's owner, key and lease.
/// @return all wrong fields of `sent`; then errors of the kind's resolve(); then of check_job(),
/// for values that come from the jobs and calibrations it names
[[nodiscard]] Result<JobRequest> job_request(const JobKind& kind, const v1::Job& sent,
                                             const JobSources& sources);

/// Checks a job whose spec has no references. Sets all of NewJob except owner, digest and retry_of.
/// @return kInvalidArgument: SPEC_INVALID (metadata field), NAME_INVALID, ID_INVALID
[[nodiscard]] Result<NewJob> check_job(const v1::Job& job);

}  // namespace hydroprint::daemon
