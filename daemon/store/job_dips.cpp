// Functions of the job store for jobs that are not computed. These jobs are never queued, and only
// one of each kind is open at a time.
#include "daemon/platform/resource_names.h"
#include "daemon/store/idempotency.h"
#include "daemon/store/job_rows.h"
#include "daemon/store/job_store.h"

namespace hydroprint::daemon {
namespace {

// Jobs that wait for an operator, run or are being cancelled.
constexpr const char* kOpen = "SELECT id FROM jobs WHERE state IN (2,3,4) AND ";

}  // namespace

Result<std::vector<std::int64_t>> JobStore::open_dips() {
  return select_numbers(
      database_, std::string(kOpen) + "EXISTS(SELECT 1 FROM dips WHERE job=jobs.id) ORDER BY id",
      {});
}

Status JobStore::check_none_open(const std::string& verb) {
  HP_ASSIGN_OR_RETURN(const auto open,
                      select_numbers(database_, std::string(kOpen) + "verb=? ORDER BY id", {verb}));
  if (open.empty()) return {};
  const std::string name = job_name(open.front());
  return tl::unexpected(
      Error{Code::kFailedPrecondition,
            "the " + verb + " " + name + " is not finished; wait for its end or cancel it first",
            "STATE_FORBIDS",
            {{verb, name}}});
}

Result<std::optional<Job>> JobStore::repeated(const std::string& owner, const RequestKey& request) {
  HP_ASSIGN_OR_RETURN(const auto earlier, earlier_result(database_, owner, request, clock_()));
  if (!earlier) return std::optional<Job>();
  HP_ASSIGN_OR_RETURN(Job job, get(parse_number(*earlier)));
  return std::optional(std::move(job));
}

Status JobStore::store_dip_status(std::int64_t id, const std::string& dip_status) {
  return database_.run("INSERT OR REPLACE INTO dips VALUES (?,?)", {id, dip_status});
}

Status JobStore::advance(std::int64_t id, JobState state, const std::string& dip_status,
                         const Progress& progress, const std::string& message) {
  const Status done = database_.transaction([&]() -> Status {
    HP_ASSIGN_OR_RETURN(const Job job, select_job(database_, id));
    if (job.state == JobState::kCancelling || is_finished(job.state)) return {};
    if (!dip_status.empty()) HP_RETURN_IF_ERROR(store_dip_status(id, dip_status));
    HP_RETURN_IF_ERROR(database_.run(
        "UPDATE jobs SET fraction=?, phase=?, phase_fraction=?, eta_ms=?, start_ms=? WHERE id=?",
        {progress.fraction, progress.phase, progress.phase_fraction, progress.eta_ms,
         job.start_ms > 0 ? job.start_ms : clock_(), id}));
    return change(id, state, message);
  });
  HP_RETURN_IF_ERROR(done);
  notifier_.ring();
  return {};
}

Result<Job> JobStore::end(std::int64_t id, JobState state, const std::optional<JobFailure>& failure,
                          const std::string& dip_status, const std::vector<Artifact>& record,
                          const std::string& message) {
  return changed(id, [&](const Job& job) -> Status {
    if (is_finished(job.state)) return {};  // repeated call, in case the first was lost
    HP_RETURN_IF_ERROR(store_artifacts(id, record));
    if (!dip_status.empty()) HP_RETURN_IF_ERROR(store_dip_status(id, dip_status));
    if (state == JobState::kSucceeded) {
      HP_RETURN_IF_ERROR(database_.run("UPDATE jobs SET fraction=1 WHERE id=?", {id}));
    }
    if (failure) return store_failure(id, *failure);
    return finish(id, state, message);
  });
}

}  // namespace hydroprint::daemon
