#pragma once

#include <string>

#include "daemon/auth/account.h"
#include "daemon/store/assets/asset_owners.h"
#include "daemon/store/job.h"
#include "daemon/store/job_store.h"
#include "hydroprint/v1/calibration_service.pb.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {

/// Returns whether a caller may see a job's artifacts and input files. The owner and operators may;
/// all users may if the job is shared.
[[nodiscard]] bool may_see(const auth::Caller& caller, const Job& job);

/// Returns kPermissionDenied, NOT_YOURS if may_see() is false for the caller.
[[nodiscard]] Status check_may_see(const auth::Caller& caller, const Job& job);

/// Returns kPermissionDenied, NOT_YOURS unless the caller is the owner of a job or an operator.
/// Only they may cancel, retry, share or delete it.
[[nodiscard]] Status check_may_change(const auth::Caller& caller, const Job& job);

/// Returns the job as this caller may see it: without its files if may_see() is false.
[[nodiscard]] v1::Job shown_to(const auth::Caller& caller, const Job& job);

/// Removes a calibration's files if the caller may not see them; the rules are those of a job with
/// the same owner.
void hide_files(const auth::Caller& caller, v1::Calibration& calibration);

/// Checks that a caller may create a job. Returns ROLE_TOO_LOW if the caller's role is lower than
/// `needed`; NOT_YOURS or JOB_NOT_FOUND if the job refers to one that the caller may not see;
/// ASSET_MISSING for files that the caller may not use.
[[nodiscard]] Status check_may_create(const auth::Caller& caller, auth::Role needed,
                                      const v1::Job& job, JobStore& jobs, Database& database);

/// Converts a caller to a user of the asset store.
[[nodiscard]] AssetUser asset_user(const auth::Caller& caller);

/// Returns ASSET_MISSING if a request has input files that the caller may not use.
[[nodiscard]] Status check_may_use_files(const auth::Caller& caller,
                                         const google::protobuf::Message& request,
                                         Database& database);

}  // namespace hydroprint::daemon
