#pragma once

#include "daemon/asset_store.h"
#include "daemon/job_store.h"
#include "daemon/layout.h"

namespace hydroprint::v1 {
class Job;
}

namespace hydroprint::daemon {

/// A print-image or template job with what it takes from its simulate job filled in; others as they
/// are. The film image becomes an asset, so that the job can be run again when the simulation is
/// gone.
/// @return SPEC_INVALID if what is to be taken is given, too; ID_INVALID, JOB_NOT_FOUND,
///   STATE_FORBIDS as earlier_job(); what AssetStore::adopt() refuses
[[nodiscard]] Result<v1::Job> with_simulated(const v1::Job& job, JobStore& jobs, AssetStore& assets,
                                             const Layout& layout);

}  // namespace hydroprint::daemon
