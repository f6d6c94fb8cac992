#pragma once

#include <filesystem>

#include "daemon/store/artifact_files.h"
#include "daemon/store/job.h"
#include "daemon/store/state_layout.h"
#include "daemon/workers/child_process.h"

namespace hydroprint::daemon {

/// Settings for running workers.
struct PoolOptions {
  std::filesystem::path program;
  std::filesystem::path confine_program;  ///< hydroprint-confine
  int cores = 1;    ///< number of processor cores, divided among workers if `threads` is 0
  int threads = 0;  ///< number of threads per worker; 0: a share of the cores
  std::int64_t memory_bytes = 0;  ///< limit per worker; 0: no limit
  std::int64_t time_limit_s = 3600;
  std::int64_t file_bytes = 4LL << 30;
  bool needs_landlock = true;            ///< as in confine::Limits
  std::string confinement_warning = {};  ///< from check_confinement(), for display
};

/// Returns the limits of the artifacts of a job.
[[nodiscard]] OutputLimits output_limits(const PoolOptions& options);

/// Creates the folder of a run with the job's options in files, but without its inputs.
[[nodiscard]] Status make_run_folder(const Job& job, const RunFolder& folder);

/// Returns how to start the worker of a job in the folder from make_run_folder().
[[nodiscard]] Launch worker_launch(const Job& job, const RunFolder& folder,
                                   const PoolOptions& options, int threads);

}  // namespace hydroprint::daemon
