#pragma once

#include "daemon/config/config.h"
#include "daemon/workers/slurm/node_jobs.h"

namespace hydroprint::daemon::slurm {

/// Checks whether jobs can run on the cluster, without a daemon and beside one: the programs of
/// Slurm, its controller, partition and account, the shared folder, and at most 32 nodes. Skips
/// checks that an earlier fault makes useless. Leaves nothing behind.
/// @param build_id  of the worker of this machine; empty: unknown
void check_cluster(const Config& config, const std::string& build_id, const CheckCaller& caller);

}  // namespace hydroprint::daemon::slurm
