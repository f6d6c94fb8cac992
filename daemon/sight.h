#pragma once

#include <string>

#include "daemon/asset_owners.h"
#include "daemon/asset_store.h"
#include "daemon/job.h"
#include "daemon/job_store.h"
#include "daemon/people/account.h"
#include "hydroprint/v1/calibration_service.pb.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::daemon {

/// Whether somebody may see a job's artifacts and of which files it was made: its owner, operators,
/// and everybody if it is shared.
[[nodiscard]] bool may_see(const people::Caller& caller, const Job& job);

/// Refuses (kPermissionDenied, NOT_YOURS) whoever may not see them.
[[nodiscard]] Status check_may_see(const people::Caller& caller, const Job& job);

/// Refuses (kPermissionDenied, NOT_YOURS) whoever may not end, repeat, share or delete a job: all
/// but its owner and operators.
[[nodiscard]] Status check_may_change(const people::Caller& caller, const Job& job);

/// The job as this caller may see it: without its files, where they may not.
[[nodiscard]] v1::Job shown_to(const people::Caller& caller, const Job& job);

/// The calibration as this caller may see it: as a job, whose owner is the calibration's.
void hide_files(const people::Caller& caller, v1::Calibration& calibration);

/// Refuses (NOT_YOURS; JOB_NOT_FOUND) a job that refers to one that the caller may not see, or
/// (ASSET_MISSING) is to be made of files that they may not use; and (ROLE_TOO_LOW) one that is
/// operators' to create.
[[nodiscard]] Status check_may_create(const people::Caller& caller, const v1::Job& job,
                                      JobStore& jobs, AssetStore& assets);

/// The caller as a user of assets.
[[nodiscard]] AssetUser asset_user(const people::Caller& caller);

/// Refuses (ASSET_MISSING) what a request names as input files and the caller may not use.
[[nodiscard]] Status check_may_use_files(const people::Caller& caller,
                                         const google::protobuf::Message& request,
                                         AssetStore& assets);

}  // namespace hydroprint::daemon
