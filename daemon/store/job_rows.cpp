#include "daemon/store/job_rows.h"

#include "daemon/platform/resource_names.h"

namespace hydroprint::daemon {
namespace {

constexpr const char* kJobColumns =
    "SELECT id, uid, display_name, owner, priority, body, verb, spec, threads, digest, retry_of, "
    "use_cache, cache_hit, state, fraction, phase, phase_fraction, eta_ms, create_ms, start_ms, "
    "end_ms, update_ms, CASE WHEN pinned=1 OR EXISTS(SELECT 1 FROM calibrations WHERE "
    "calibrations.job=jobs.id) THEN 0 ELSE purge_ms END, version, error_code, error_reason, "
    "error_message, exit_status, "
    "signal, (SELECT status FROM dips WHERE job=jobs.id), shared, pinned, computed, "
    "reads_artifacts, interrupted_advice, attempts, waits_for, error_field FROM jobs ";

std::optional<JobFailure> read_failure(const DbRow& row) {
  if (row.is_null(24)) return std::nullopt;
  JobFailure failure;
  failure.error.code = static_cast<Code>(row.integer(24));
  parse(row.text(25), failure.error.reason);
  failure.error.message = row.text(26);
  failure.error.field = row.text(37);
  if (!row.is_null(27)) failure.exit_status = static_cast<std::int32_t>(row.integer(27));
  if (!row.is_null(28)) failure.signal = static_cast<std::int32_t>(row.integer(28));
  return failure;
}

Job read_job(const DbRow& row) {
  Job job;
  job.id = row.integer(0);
  job.uid = row.text(1);
  job.definition.display_name = row.text(2);
  job.definition.owner = row.text(3);
  job.definition.priority = static_cast<std::int32_t>(row.integer(4));
  job.definition.body = row.text(5);
  job.definition.work.verb = row.text(6);
  job.definition.work.spec = row.text(7);
  job.definition.traits = {row.integer(32) != 0, row.integer(33) != 0, row.text(34)};
  job.definition.threads = static_cast<std::int32_t>(row.integer(8));
  job.definition.digest = row.text(9);
  job.definition.retry_of = row.integer(10);
  job.definition.use_cache = row.integer(11) != 0;
  job.cache_hit = row.integer(12) != 0;
  job.state = static_cast<JobState>(row.integer(13));
  job.progress = {row.real(14), row.text(15), row.real(16), row.integer(17)};
  job.create_ms = row.integer(18);
  job.start_ms = row.integer(19);
  job.end_ms = row.integer(20);
  job.update_ms = row.integer(21);
  job.purge_ms = row.integer(22);
  job.version = row.integer(23);
  job.failure = read_failure(row);
  job.dip_status = row.text(29);
  job.shared = row.integer(30) != 0;
  job.pinned = row.integer(31) != 0;
  job.attempts = row.integer(35);
  job.progress.waits_for = row.text(36);
  return job;
}

JobEvent read_event(const DbRow& row) {
  JobEvent event;
  event.seq = row.integer(0);
  event.time_ms = row.integer(1);
  event.job = row.integer(2);
  event.kind = static_cast<EventKind>(row.integer(3));
  event.state = static_cast<JobState>(row.integer(4));
  event.progress = {row.real(5), row.text(6), row.real(7), row.integer(8)};
  event.message = row.text(9);
  event.progress.waits_for = row.text(10);
  return event;
}

}  // namespace

Result<std::vector<Job>> select_jobs(Database& database, const std::string& where,
                                     std::initializer_list<DbValue> values) {
  std::vector<Job> jobs;
  HP_RETURN_IF_ERROR(database.each(kJobColumns + where, values,
                                   [&](const DbRow& row) { jobs.push_back(read_job(row)); }));
  return jobs;
}

Result<Job> select_job(Database& database, std::int64_t id) {
  HP_ASSIGN_OR_RETURN(auto jobs, select_jobs(database, "WHERE id=?", {id}));
  if (jobs.empty()) {
    return fail(Code::kNotFound, job_name(id) + " does not exist", ErrorReason::JOB_NOT_FOUND);
  }
  Job job = std::move(jobs.front());
  HP_RETURN_IF_ERROR(
      database.each("SELECT name, sha256 FROM job_inputs WHERE job=?", {id}, [&](const DbRow& row) {
        job.definition.work.inputs.push_back({row.text(0), row.text(1)});
      }));
  return job;
}

Result<std::vector<JobEvent>> select_events(Database& database, const std::string& where,
                                            std::initializer_list<DbValue> values) {
  std::vector<JobEvent> events;
  HP_RETURN_IF_ERROR(database.each(
      "SELECT seq, time_ms, job, kind, state, fraction, phase, phase_fraction, eta_ms, message, "
      "waits_for "
      "FROM events " +
          where,
      values, [&](const DbRow& row) { events.push_back(read_event(row)); }));
  return events;
}

Result<std::vector<Artifact>> select_artifacts(Database& database, const std::string& where,
                                               std::initializer_list<DbValue> values) {
  std::vector<Artifact> artifacts;
  HP_RETURN_IF_ERROR(
      database.each("SELECT name, size, sha256, media_type FROM artifacts " + where, values,
                    [&](const DbRow& row) {
                      artifacts.push_back({row.text(0), row.integer(1), row.text(2), row.text(3)});
                    }));
  return artifacts;
}

Result<std::vector<std::int64_t>> select_numbers(Database& database, const std::string& sql,
                                                 std::initializer_list<DbValue> values) {
  std::vector<std::int64_t> numbers;
  HP_RETURN_IF_ERROR(
      database.each(sql, values, [&](const DbRow& row) { numbers.push_back(row.integer(0)); }));
  return numbers;
}

Status insert_execution(Database& database, const Execution& execution) {
  return database.run("INSERT INTO executions VALUES (?,?,?,?,?)",
                      {execution.job, execution.attempt, execution.executor, execution.handle,
                       execution.folder.string()});
}

Status close_execution(Database& database, std::int64_t job) {
  return database.run("DELETE FROM executions WHERE job=?", {job});
}

Status store_handle(Database& database, const Execution& execution) {
  return database.run("UPDATE executions SET handle=? WHERE job=? AND attempt=?",
                      {execution.handle, execution.job, execution.attempt});
}

Result<std::vector<Execution>> select_executions(Database& database) {
  std::vector<Execution> out;
  HP_RETURN_IF_ERROR(database.each(
      "SELECT job, attempt, executor, handle, folder FROM executions ORDER BY job", {},
      [&](const DbRow& row) {
        out.push_back({row.integer(0), row.integer(1), row.text(2), row.text(3), row.text(4)});
      }));
  return out;
}

}  // namespace hydroprint::daemon
