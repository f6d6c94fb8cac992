#include "daemon/workers/worker_launch.h"

#include <fmt/format.h>

#include <algorithm>

namespace hydroprint::daemon {
namespace {

// Returns the job's options: its spec, or its flags if an earlier version of the daemon stored it.
std::vector<std::string> options_of(const Job& job, const RunFolder& folder) {
  const Work& work = job.definition.work;
  if (!work.spec.empty()) return spec_options(folder.spec());
  std::vector<std::string> out = work.flags;
  if (!work.pose_json.empty()) out.push_back("--pose=" + folder.pose().string());
  return out;
}

}  // namespace

Status make_run_folder(const Job& job, const RunFolder& folder) {
  const Work& work = job.definition.work;
  HP_RETURN_IF_ERROR(make_folder(folder.work()));
  if (!work.spec.empty()) return write_file(folder.spec(), work.spec);
  return work.pose_json.empty() ? Status() : write_file(folder.pose(), work.pose_json);
}

Launch worker_launch(const Job& job, const RunFolder& folder, const PoolOptions& options,
                     int threads) {
  Launch launch;
  launch.program = options.program;
  launch.confine_program = options.confine_program;
  launch.inputs = folder.inputs();
  launch.work = folder.work();
  launch.arguments = {job.definition.work.verb};
  for (std::string& option : options_of(job, folder)) {
    launch.arguments.push_back(std::move(option));
  }
  launch.threads = threads;
  launch.arguments.push_back(fmt::format("--threads={}", threads));
  launch.arguments.push_back("--out=" + folder.out().string());
  launch.arguments.emplace_back("--json");
  launch.limits = {options.memory_bytes,
                   options.time_limit_s * std::max(threads, options.cores) + 10,
                   options.file_bytes};
  return launch;
}

}  // namespace hydroprint::daemon
