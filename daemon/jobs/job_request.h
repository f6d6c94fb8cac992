#pragma once

#include "daemon/jobs/executor.h"
#include "daemon/jobs/kind.h"

namespace hydroprint::daemon {

/// Resolves and checks a job that a client sent; proto/hydroprint/v1/spec.proto describes the
/// errors. Sets all of the request except NewJob::owner, the key and the lease.
/// @return an error that lists all wrong fields of `sent`; otherwise an error of
/// JobKind::resolve(); otherwise an error of check_job() for a value from a job or calibration that
/// `sent` names
[[nodiscard]] Result<JobRequest> job_request(const JobKind& kind, const v1::Job& sent,
                                             const JobSources& sources);

/// Checks a job whose spec has no references. Sets all of NewJob except owner, body, digest,
/// retry_of and dip_status.
/// @return kInvalidArgument: SPEC_INVALID (with the field), NAME_INVALID, ID_INVALID
[[nodiscard]] Result<NewJob> check_job(const v1::Job& job);

}  // namespace hydroprint::daemon
