#include "daemon/store/device_jobs.h"

#include <fmt/format.h>

#include "daemon/platform/resource_names.h"
#include "daemon/store/job_rows.h"

namespace hydroprint::daemon {
namespace {

// SQL condition for jobs that wait for an operator, run or are being cancelled.
constexpr const char* kIsOpen = "state IN (2,3,4)";

}  // namespace

Status check_none_open(Database& database, const std::string& verb) {
  HP_ASSIGN_OR_RETURN(
      const auto open,
      select_numbers(database,
                     fmt::format("SELECT id FROM jobs WHERE {} AND verb=? ORDER BY id", kIsOpen),
                     {verb}));
  if (open.empty()) return {};
  const std::string name = job_name(open.front());
  return tl::unexpected(Error{
      Code::kFailedPrecondition,
      fmt::format("the {} {} is not finished; wait until it ends, or cancel it first", verb, name),
      ErrorReason::STATE_FORBIDS,
      {{verb, name}}});
}

Status store_dip_status(Database& database, std::int64_t id, const std::string& dip_status) {
  return database.run("INSERT OR REPLACE INTO dips VALUES (?,?)", {id, dip_status});
}

Result<std::vector<Job>> DeviceJobs::open_dips() {
  return select_jobs(
      database_,
      fmt::format("WHERE {} AND EXISTS(SELECT 1 FROM dips WHERE job=jobs.id) ORDER BY id", kIsOpen),
      {});
}

Status DeviceJobs::advance(std::int64_t id, JobState state, const std::string& dip_status,
                           const Progress& progress, const std::string& message) {
  return changes_.transaction([&]() -> Status {
    HP_ASSIGN_OR_RETURN(const Job job, select_job(database_, id));
    if (job.state == JobState::kCancelling || is_finished(job.state)) return {};
    if (!dip_status.empty()) HP_RETURN_IF_ERROR(store_dip_status(database_, id, dip_status));
    HP_RETURN_IF_ERROR(database_.run(
        "UPDATE jobs SET fraction=?, phase=?, phase_fraction=?, eta_ms=?, start_ms=? WHERE id=?",
        {progress.fraction, progress.phase, progress.phase_fraction, progress.eta_ms,
         job.start_ms > 0 ? job.start_ms : changes_.now_ms(), id}));
    return changes_.set_state(id, state, message);
  });
}

Result<Job> DeviceJobs::end(std::int64_t id, JobState state,
                            const std::optional<JobFailure>& failure, const std::string& dip_status,
                            const std::vector<Artifact>& record, const std::string& message) {
  return changes_.change(id, [&](const Job& job) -> Status {
    if (is_finished(job.state)) return {};  // an earlier call has already ended the job
    HP_RETURN_IF_ERROR(changes_.add_artifacts(id, record));
    if (!dip_status.empty()) HP_RETURN_IF_ERROR(store_dip_status(database_, id, dip_status));
    if (state == JobState::kSucceeded) {
      HP_RETURN_IF_ERROR(database_.run("UPDATE jobs SET fraction=1 WHERE id=?", {id}));
    }
    if (failure) return changes_.finish_failed(id, *failure);
    return changes_.finish(id, state, message);
  });
}

}  // namespace hydroprint::daemon
