#include "daemon/workers/worker_launch.h"

#include <fmt/format.h>

#include <algorithm>

namespace hydroprint::daemon {

OutputLimits output_limits(const PoolOptions& options) {
  constexpr int kMostFullFiles = 4;  // artifacts of the largest size that a job may have
  return {options.file_bytes, kMostFullFiles * options.file_bytes};
}

Status make_run_folder(const Job& job, const RunFolder& folder) {
  HP_RETURN_IF_ERROR(make_folder(folder.work()));
  return write_file(folder.spec(), job.definition.work.spec);
}

Launch worker_launch(const Job& job, const RunFolder& folder, const PoolOptions& options,
                     int threads) {
  Launch launch;
  launch.program = options.program;
  launch.confine_program = options.confine_program;
  launch.inputs = folder.inputs();
  launch.work = folder.work();
  launch.arguments = {job.definition.work.verb};
  for (std::string& option : spec_options(folder.spec())) {
    launch.arguments.push_back(std::move(option));
  }
  launch.threads = threads;
  launch.arguments.push_back(fmt::format("--threads={}", threads));
  launch.arguments.push_back("--out=" + folder.out().string());
  launch.arguments.emplace_back("--json");
  launch.limits = {options.memory_bytes,
                   options.time_limit_s * std::max(threads, options.cores) + 10, options.file_bytes,
                   options.needs_landlock};
  launch.written_bytes = output_limits(options).total_bytes;
  return launch;
}

}  // namespace hydroprint::daemon
