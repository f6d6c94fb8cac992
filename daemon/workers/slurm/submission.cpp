#include "daemon/workers/slurm/submission.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "daemon/workers/command_run.h"
#include "daemon/workers/slurm/queue.h"
#include "daemon/workers/slurm/run_files.h"
#include "daemon/workers/slurm/script.h"

namespace hydroprint::daemon::slurm {
namespace {

constexpr std::chrono::milliseconds kCallPatience{1000};
constexpr std::int64_t kMiB = 1 << 20;

}  // namespace

std::vector<std::string> sbatch_options(const Settings& settings, const Execution& execution,
                                        const Launch& launch) {
  std::vector<std::string> out{"--job-name=" + job_name(execution.folder),
                               "--no-requeue",
                               "--export=ALL",
                               "--propagate=NONE",
                               "--chdir=/",
                               "--input=/dev/null",
                               "--output=/dev/null",
                               "--nodes=1",
                               "--ntasks=1",
                               fmt::format("--cpus-per-task={}", launch.threads),
                               fmt::format("--time={}", (settings.time_limit_s + 59) / 60)};
  if (launch.limits.memory_bytes > 0) {
    out.push_back(fmt::format("--mem={}", launch.limits.memory_bytes / kMiB));
  }
  if (!settings.partition.empty()) out.push_back("--partition=" + settings.partition);
  if (!settings.account.empty()) out.push_back("--account=" + settings.account);
  out.insert(out.end(), settings.options.begin(), settings.options.end());
  return out;
}

namespace {

// Returns whether sbatch will say the same again. Everything else passes: a controller that is
// down, busy or out of job slots.
bool is_final(const CommandEnd& end) {
  constexpr int kBadOption = 255;
  constexpr std::array<std::string_view, 8> kFinal{
      "invalid partition", "Invalid", "not available", "can not be satisfied",
      "Unable to open",    "denied",  "not permitted", "look like a batch script"};
  return end.status == kBadOption ||
         std::any_of(kFinal.begin(), kFinal.end(), [&](std::string_view part) {
           return end.errors.find(part) != std::string::npos;
         });
}

bool is_id(std::string_view text) {
  return !text.empty() && text.size() <= 20 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

Status write_script(const Settings& settings, const Execution& execution, const Launch& launch) {
  const RunFolder folder{execution.folder};
  Launch with_progress = launch;
  with_progress.arguments.push_back("--progress-file=" + progress_file(folder).string());
  const ScriptPlan plan{sbatch_options(settings, execution, launch),
                        folder.root,
                        launch.program,
                        launch.build_id,
                        command_of(with_progress),
                        folder.inputs()};
  return write_file(script_file(folder), batch_script(plan));
}

Result<Submitted> submit(const Execution& execution) {
  const RunFolder folder{execution.folder};
  const auto end = run_command({"sbatch", "--parsable", script_file(folder).string()},
                               folder.work(), kCallPatience);
  if (!end) return Submitted{.words = end.error().message};
  if (end->status < 0) return Submitted{.is_silent = true};
  if (end->status == 0) {
    // "ID", or "ID;CLUSTER" in a federation
    std::string id = end->output.substr(0, end->output.find_first_of(";\n"));
    return Submitted{.id = is_id(id) ? std::move(id) : ""};
  }
  if (!is_final(*end)) return Submitted{.words = end->errors};
  return fail(Code::kInternal,
              fmt::format("Slurm refused the job: {}; check [workers.slurm], and run hydroprint "
                          "admin check",
                          end->errors.empty() ? "sbatch gave no reason" : end->errors),
              ErrorReason::WORKER_UNUSABLE);
}

Status end_job(const std::string& name, const std::filesystem::path& folder) {
  HP_ASSIGN_OR_RETURN(const CommandEnd end,
                      run_command({"scancel", "--me", "--name=" + name}, folder, kCallPatience));
  if (end.status == 0) return {};
  return fail(Code::kUnavailable, "scancel: " + (end.errors.empty() ? "no answer" : end.errors));
}

}  // namespace hydroprint::daemon::slurm
