#pragma once

#include <string>

#include "daemon/auth/account.h"
#include "daemon/store/assets/asset_owners.h"
#include "daemon/store/job.h"
#include "daemon/store/job_store.h"
#include "hydroprint/v1/calibration_service.pb.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {

/// Whether a caller may see a job's artifacts and input files: its owner and operators, and
/// everybody if the job is shared.
[[nodiscard]] bool may_see(const auth::Caller& caller, const Job& job);

/// Refuses (kPermissionDenied, NOT_YOURS) a caller for whom may_see() is false.
[[nodiscard]] Status check_may_see(const auth::Caller& caller, const Job& job);

/// Refuses (kPermissionDenied, NOT_YOURS) a caller who is neither the owner of a job nor an
/// operator. Only these may cancel, retry, share or delete it.
[[nodiscard]] Status check_may_change(const auth::Caller& caller, const Job& job);

/// The job as this caller may see it: without its files if may_see() is false.
[[nodiscard]] v1::Job shown_to(const auth::Caller& caller, const Job& job);

/// Removes a calibration's files if the caller may not see them; the rules are those of a job with
/// the same owner.
void hide_files(const auth::Caller& caller, v1::Calibration& calibration);

/// Refuses a caller who lacks the role for the job (ROLE_TOO_LOW), a job that refers to one that
/// the caller may not see (NOT_YOURS; JOB_NOT_FOUND), and files that the caller may not use
/// (ASSET_MISSING).
[[nodiscard]] Status check_may_create(const auth::Caller& caller, auth::Role needed,
                                      const v1::Job& job, JobStore& jobs, Database& database);

/// The caller, as the asset store sees users.
[[nodiscard]] AssetUser asset_user(const auth::Caller& caller);

/// Refuses (ASSET_MISSING) input files of a request that the caller may not use.
[[nodiscard]] Status check_may_use_files(const auth::Caller& caller,
                                         const google::protobuf::Message& request,
                                         Database& database);

}  // namespace hydroprint::daemon
