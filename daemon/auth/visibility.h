#pragma once

#include <string>

#include "daemon/auth/account.h"
#include "daemon/store/asset_owners.h"
#include "daemon/store/asset_store.h"
#include "daemon/store/job.h"
#include "daemon/store/job_store.h"
#include "hydroprint/v1/calibration_service.pb.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {

/// Whether somebody may see a job's artifacts and of which files it was made: its owner, operators,
/// and everybody if it is shared.
[[nodiscard]] bool may_see(const auth::Caller& caller, const Job& job);

/// Refuses (kPermissionDenied, NOT_YOURS) whoever may not see them.
[[nodiscard]] Status check_may_see(const auth::Caller& caller, const Job& job);

/// Refuses (kPermissionDenied, NOT_YOURS) whoever may not end, repeat, share or delete a job: all
/// but its owner and operators.
[[nodiscard]] Status check_may_change(const auth::Caller& caller, const Job& job);

/// The job as this caller may see it: without its files, where they may not.
[[nodiscard]] v1::Job shown_to(const auth::Caller& caller, const Job& job);

/// The calibration as this caller may see it: as a job, whose owner is the calibration's.
void hide_files(const auth::Caller& caller, v1::Calibration& calibration);

/// Refuses (ROLE_TOO_LOW) a caller without the role that the job needs, (NOT_YOURS; JOB_NOT_FOUND)
/// a job that refers to one that the caller may not see, and (ASSET_MISSING) one with files that
/// they may not use.
[[nodiscard]] Status check_may_create(const auth::Caller& caller, auth::Role needed,
                                      const v1::Job& job, JobStore& jobs, AssetStore& assets);

/// The caller as a user of assets.
[[nodiscard]] AssetUser asset_user(const auth::Caller& caller);

/// Refuses (ASSET_MISSING) what a request names as input files and the caller may not use.
[[nodiscard]] Status check_may_use_files(const auth::Caller& caller,
                                         const google::protobuf::Message& request,
                                         AssetStore& assets);

}  // namespace hydroprint::daemon
