#include "daemon/workers/slurm/settings.h"

#include "daemon/config/slurm_config.h"

namespace hydroprint::daemon::slurm {

Settings settings_of(const Config& config) {
  return {config.slurm_folder,        config.slurm_installation,
          config.slurm_partition,     config.slurm_account,
          slurm_options(config),      static_cast<int>(config.slurm_jobs),
          config.workers_time_limit_s};
}

}  // namespace hydroprint::daemon::slurm
