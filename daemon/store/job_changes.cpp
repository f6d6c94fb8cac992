#include "daemon/store/job_changes.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "daemon/store/job_rows.h"

namespace hydroprint::daemon {

JobChanges::JobChanges(Database& database, const RetentionTimes& times, Clock clock)
    : database_(database), times_(times), clock_(std::move(clock)) {}

Status JobChanges::transaction(const std::function<Status()>& body) {
  HP_RETURN_IF_ERROR(database_.transaction(body));
  notifier_.ring();
  return {};
}

Result<Job> JobChanges::change(std::int64_t id, const std::function<Status(const Job&)>& body) {
  Job after;
  const Status done = transaction([&]() -> Status {
    HP_ASSIGN_OR_RETURN(const Job job, select_job(database_, id));
    HP_RETURN_IF_ERROR(body(job));
    HP_ASSIGN_OR_RETURN(after, select_job(database_, id));
    return {};
  });
  HP_RETURN_IF_ERROR(done);
  return after;
}

Status JobChanges::add_event(std::int64_t id, EventKind kind, const std::string& message) {
  return database_.run(
      "INSERT INTO events(job, time_ms, kind, state, fraction, phase, phase_fraction, eta_ms, "
      "waits_for, message) SELECT id, ?, ?, state, fraction, phase, phase_fraction, eta_ms, "
      "waits_for, ? FROM jobs WHERE id=?",
      {clock_(), number(kind), message, id});
}

Status JobChanges::add_artifacts(std::int64_t id, const std::vector<Artifact>& artifacts) {
  for (const Artifact& file : artifacts) {
    HP_RETURN_IF_ERROR(
        database_.run("INSERT INTO artifacts VALUES (?,?,?,?,?)",
                      {id, file.name, file.size_bytes, file.sha256, file.media_type}));
  }
  return {};
}

Status JobChanges::set_state(std::int64_t id, JobState state, const std::string& message) {
  HP_RETURN_IF_ERROR(
      database_.run("UPDATE jobs SET state=?, update_ms=?, version=version+1 WHERE id=?",
                    {number(state), clock_(), id}));
  return add_event(id, EventKind::kStateChanged, message);
}

Status JobChanges::finish(std::int64_t id, JobState state, const std::string& message) {
  const std::int64_t now = clock_();
  HP_RETURN_IF_ERROR(
      database_.run("UPDATE jobs SET end_ms=?1, keep_from_ms=?1, phase='', phase_fraction=0, "
                    "eta_ms=0, waits_for='' WHERE id=?2",
                    {now, id}));
  HP_RETURN_IF_ERROR(set_purge_time("id=?", id));
  HP_RETURN_IF_ERROR(close_execution(database_, id));
  HP_RETURN_IF_ERROR(database_.run("DELETE FROM events WHERE job=? AND kind=?",
                                   {id, number(EventKind::kProgress)}));
  return set_state(id, state, message);
}

Status JobChanges::finish_failed(std::int64_t id, const JobFailure& failure) {
  const auto optional = [](const std::optional<std::int32_t>& value) {
    return value ? DbValue(std::int64_t{*value}) : DbValue();
  };
  HP_RETURN_IF_ERROR(database_.run(
      "UPDATE jobs SET error_code=?, error_reason=?, error_message=?, error_field=?, "
      "exit_status=?, signal=? WHERE id=?",
      {static_cast<std::int64_t>(failure.error.code), std::string(name_of(failure.error.reason)),
       failure.error.message, failure.error.field, optional(failure.exit_status),
       optional(failure.signal), id}));
  return finish(id, JobState::kFailed, failure.error.message);
}

Status JobChanges::set_purge_time(const std::string& where, std::int64_t value) {
  const std::int64_t keep = times_.finished_ms, keep_dips = times_.dips_ms;
  const bool for_ever = keep == 0 || keep_dips == 0;
  return database_.run(
      "UPDATE jobs SET purge_ms=coalesce(keep_from_ms+nullif(CASE WHEN EXISTS(SELECT 1 FROM dips "
      "WHERE job=jobs.id) THEN ?2 ELSE ?3 END, 0), 0) WHERE " +
          std::string(where).replace(where.find('?'), 1, "?1"),
      {value, for_ever ? std::int64_t{0} : std::max(keep, keep_dips), keep});
}

}  // namespace hydroprint::daemon
