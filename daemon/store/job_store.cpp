#include "daemon/store/job_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "daemon/platform/durable_file.h"
#include "daemon/platform/log.h"
#include "daemon/platform/resource_names.h"
#include "daemon/store/asset.h"
#include "daemon/store/calibration_store.h"
#include "daemon/store/device_jobs.h"
#include "daemon/store/idempotency.h"
#include "daemon/store/job_rows.h"

namespace hydroprint::daemon {
namespace {

tl::unexpected<Error> state_forbids(const Job& job, const std::string& remedy) {
  auto error = fail(Code::kFailedPrecondition,
                    job_name(job.id) + " is " + name_of(job.state) + "; " + remedy,
                    ErrorReason::STATE_FORBIDS);
  error.value().metadata["state"] = name_of(job.state);
  return error;
}

// Returns SQL that selects the newest jobs in these states (of the owner ?1, if there is one) by an
// index. A `+` keeps SQLite from using the other one: few jobs are open, but most of an owner's
// jobs may be in one final state.
std::string newest_in_states(const JobFilter& filter, const std::string& newest) {
  std::vector<std::string> conditions, finished;
  for (const JobState state : std::set(filter.states.begin(), filter.states.end())) {
    if (is_finished(state) && !filter.owner.empty()) {
      finished.push_back(fmt::to_string(number(state)));
    } else {
      conditions.push_back(
          fmt::format("state={}{}", number(state), filter.owner.empty() ? "" : " AND +owner=?1"));
    }
  }
  if (!finished.empty()) {
    conditions.push_back(fmt::format("owner=?1 AND +state IN ({})", fmt::join(finished, ",")));
  }
  for (std::string& each : conditions) {
    each = fmt::format("SELECT * FROM (SELECT id FROM jobs WHERE {} AND {})", each, newest);
  }
  return fmt::format("{}", fmt::join(conditions, " UNION ALL "));
}

}  // namespace

JobStore::JobStore(JobChanges& changes, const Layout& layout, const JobStoreOptions& options)
    : changes_(changes), database_(changes.database()), layout_(layout), options_(options) {}

Status JobStore::check_inputs(const std::vector<InputFile>& inputs) {
  for (const InputFile& input : inputs) {
    HP_ASSIGN_OR_RETURN(
        const auto found,
        select_numbers(database_, "SELECT 1 FROM assets WHERE sha256=?", {input.sha256}));
    if (found.empty()) return asset_missing(input);
  }
  return {};
}

Status JobStore::check_queue() {
  HP_ASSIGN_OR_RETURN(const auto queued,
                      select_numbers(database_, "SELECT count(*) FROM jobs WHERE state=?",
                                     {number(JobState::kQueued)}));
  if (queued.front() >= options_.max_queued) {
    return fail(Code::kResourceExhausted,
                fmt::format("the queue is full ({} jobs); try again when some have finished",
                            options_.max_queued),
                ErrorReason::QUEUE_FULL);
  }
  return {};
}

Result<std::int64_t> JobStore::insert(const NewJob& definition) {
  const JobTraits& traits = definition.traits;
  const bool is_dip = !definition.dip_status.empty();
  const JobState state = traits.computed ? JobState::kQueued
                         : is_dip        ? JobState::kWaitingForOperator
                                         : JobState::kRunning;
  HP_RETURN_IF_ERROR(traits.computed ? check_queue()
                                     : check_none_open(database_, definition.work.verb));
  HP_RETURN_IF_ERROR(check_job_quota(database_, definition.owner, options_.quota, traits.computed));
  HP_RETURN_IF_ERROR(check_inputs(definition.work.inputs));
  const std::int64_t now = changes_.now_ms();
  HP_RETURN_IF_ERROR(database_.run(
      "INSERT INTO jobs(uid, display_name, owner, priority, rank, body, verb, spec, "
      "computed, reads_artifacts, interrupted_advice, threads, digest, retry_of, use_cache, state, "
      "start_ms, create_ms, update_ms) VALUES (?,?,?,?,0,?,?,?,?,?,?,?,?,?,?,?,?,?,?)",
      {make_uuid(), definition.display_name, definition.owner, std::int64_t{definition.priority},
       definition.body, definition.work.verb, definition.work.spec, std::int64_t{traits.computed},
       std::int64_t{traits.reads_artifacts}, traits.interrupted_advice,
       std::int64_t{definition.threads}, definition.digest, definition.retry_of,
       std::int64_t{definition.use_cache}, number(state), state == JobState::kRunning ? now : 0,
       now, now}));
  const std::int64_t id = database_.last_id();
  // Later jobs rank after earlier ones; moving a job permutes the ranks.
  HP_RETURN_IF_ERROR(database_.run("UPDATE jobs SET rank=id WHERE id=?", {id}));
  for (const InputFile& input : definition.work.inputs) {
    HP_RETURN_IF_ERROR(
        database_.run("INSERT INTO job_inputs VALUES (?,?,?)", {id, input.name, input.sha256}));
    HP_RETURN_IF_ERROR(
        database_.run("UPDATE assets SET use_ms=? WHERE sha256=?", {now, input.sha256}));
  }
  if (is_dip) HP_RETURN_IF_ERROR(store_dip_status(database_, id, definition.dip_status));
  HP_RETURN_IF_ERROR(changes_.add_event(id, EventKind::kStateChanged, ""));
  return id;
}

Result<Job> JobStore::create(const NewJob& definition, const RequestKey& request) {
  std::int64_t id = 0, inserted = 0;
  HP_RETURN_IF_ERROR(find_equal(definition));  // reads its files before the transaction
  const Status done = changes_.transaction([&]() -> Status {
    HP_ASSIGN_OR_RETURN(const auto earlier,
                        earlier_result(database_, definition.owner, request, changes_.now_ms()));
    if (earlier) {
      id = parse_number(*earlier);
      return {};
    }
    HP_ASSIGN_OR_RETURN(inserted, insert(definition));
    id = inserted;
    HP_ASSIGN_OR_RETURN(const Job job, select_job(database_, id));
    HP_RETURN_IF_ERROR(adopt_cached(job));
    return remember_result(database_, definition.owner, request, std::to_string(id),
                           changes_.now_ms());
  });
  if (!done && inserted != 0) discard_unowned(inserted);
  HP_RETURN_IF_ERROR(done);
  return get(id);
}

Result<std::optional<Job>> JobStore::repeated(const std::string& owner, const RequestKey& request) {
  HP_ASSIGN_OR_RETURN(const auto earlier,
                      earlier_result(database_, owner, request, changes_.now_ms()));
  if (!earlier) return std::optional<Job>();
  HP_ASSIGN_OR_RETURN(Job job, get(parse_number(*earlier)));
  return std::optional(std::move(job));
}

// Finds a finished job with the same inputs whose artifacts can be reused. Reads their files, which
// may take long the first time.
Result<JobStore::EqualJob> JobStore::find_equal(const NewJob& definition) {
  if (!definition.use_cache || !definition.traits.computed) return EqualJob{};
  HP_ASSIGN_OR_RETURN(
      const auto equal,
      // Without the `+`, SQLite would use the index of states, which finds nearly all jobs.
      select_numbers(database_,
                     "SELECT id FROM jobs WHERE digest=? AND +state=? ORDER BY id DESC LIMIT 1",
                     {definition.digest, number(JobState::kSucceeded)}));
  if (equal.empty()) return EqualJob{};
  EqualJob found{equal.front(), {}};
  HP_ASSIGN_OR_RETURN(found.files,
                      select_artifacts(database_, "WHERE job=? ORDER BY name", {found.id}));
  for (const Artifact& file : found.files) {
    if (!check_file(found.id, file, {})) return EqualJob{};  // damaged: compute the job
  }
  return found;
}

// Reuses the artifacts of a finished job with the same inputs, if there is one.
Result<bool> JobStore::adopt_cached(const Job& job) {
  HP_ASSIGN_OR_RETURN(const EqualJob equal, find_equal(job.definition));
  if (equal.id == 0) return false;
  const auto folder = layout_.artifacts(job.id);
  discard(folder);
  HP_RETURN_IF_ERROR(make_folder(folder));
  for (const Artifact& file : equal.files) {
    if (link_or_copy(layout_.artifacts(equal.id) / file.name, folder / file.name)) continue;
    discard(folder);
    return false;
  }
  HP_RETURN_IF_ERROR(sync_path(folder));
  HP_RETURN_IF_ERROR(changes_.add_artifacts(job.id, equal.files));
  HP_RETURN_IF_ERROR(database_.run("UPDATE jobs SET cache_hit=1, fraction=1 WHERE id=?", {job.id}));
  HP_RETURN_IF_ERROR(changes_.finish(
      job.id, JobState::kSucceeded, "same inputs as " + job_name(equal.id) + "; artifacts reused"));
  return true;
}

// Deletes the artifact folder of a job that has not succeeded. Needed if the transaction that
// reused the artifacts of another job has failed.
void JobStore::discard_unowned(std::int64_t id) {
  (void)database_.transaction([&]() -> Status {
    HP_ASSIGN_OR_RETURN(const auto owner,
                        select_numbers(database_, "SELECT id FROM jobs WHERE id=? AND state=?",
                                       {id, number(JobState::kSucceeded)}));
    if (owner.empty()) discard(layout_.artifacts(id));
    return {};
  });
}

Result<Job> JobStore::get(std::int64_t id) {
  Result<Job> job = fail(Code::kInternal, "");
  // One transaction, so that the job and its inputs are consistent.
  const Status done = database_.transaction([&]() -> Status {
    job = select_job(database_, id);
    return {};
  });
  HP_RETURN_IF_ERROR(done);
  return job;
}

Result<std::vector<Job>> JobStore::list(const JobFilter& filter) {
  const std::string newest =
      std::string(filter.before_id > 0 ? "id<?2" : "id>?2") + " ORDER BY id DESC LIMIT ?3";
  std::string where = (filter.owner.empty() ? "WHERE " : "WHERE owner=?1 AND ") + newest;
  if (!filter.states.empty()) {
    where =
        fmt::format("WHERE id IN ({}) ORDER BY id DESC LIMIT ?3", newest_in_states(filter, newest));
  }
  return select_jobs(database_, where,
                     {filter.owner, filter.before_id, std::int64_t{filter.limit}});
}

Status JobStore::remove(std::int64_t id) {
  const Status done = changes_.transaction([&]() -> Status {
    HP_ASSIGN_OR_RETURN(const Job job, select_job(database_, id));
    if (!is_finished(job.state)) return state_forbids(job, "cancel it first");
    HP_ASSIGN_OR_RETURN(const std::int64_t calibration, calibration_of_job(database_, id));
    if (calibration != 0) {
      return state_forbids(
          job, "delete " + calibration_name(calibration) + ", which this job produced, first");
    }
    return database_.run("DELETE FROM jobs WHERE id=?", {id});
  });
  HP_RETURN_IF_ERROR(done);
  discard(layout_.artifacts(id));
  return {};
}

Result<Job> JobStore::share(std::int64_t id, bool shared) {
  return changes_.change(id, [&](const Job&) {
    return database_.run("UPDATE jobs SET shared=?, update_ms=?, version=version+1 WHERE id=?",
                         {std::int64_t{shared}, changes_.now_ms(), id});
  });
}

Result<Job> JobStore::cancel(std::int64_t id) {
  const auto mark = [&](const Job& job) -> Status {
    switch (job.state) {
      case JobState::kQueued:
        return changes_.finish(id, JobState::kCancelled, "");
      case JobState::kWaitingForOperator:
      case JobState::kRunning:
        return changes_.set_state(id, JobState::kCancelling, "");
      case JobState::kCancelling:
      case JobState::kCancelled:
        return {};
      default:
        return state_forbids(job, "it cannot be cancelled");
    }
  };
  auto marked = changes_.change(id, mark);
  // This job may have filled the disk. The first attempt has emptied the database's log, so try
  // again.
  if (!marked && marked.error().reason == ErrorReason::DISK_FULL)
    marked = changes_.change(id, mark);
  return marked;
}

Result<Job> JobStore::start(std::int64_t id, const std::string& executor,
                            const std::filesystem::path& runs) {
  HP_ASSIGN_OR_RETURN(const Job queued, get(id));
  HP_RETURN_IF_ERROR(find_equal(queued.definition));  // reads its files before the transaction
  auto started = changes_.change(id, [&](const Job& job) -> Status {
    if (job.state != JobState::kQueued) return state_forbids(job, "only a queued job can start");
    HP_ASSIGN_OR_RETURN(const bool cached, adopt_cached(job));
    if (cached) return {};
    HP_RETURN_IF_ERROR(database_.run(
        "UPDATE jobs SET start_ms=?, fraction=0, phase='', phase_fraction=0, eta_ms=0, "
        "waits_for='', attempts=attempts+1 WHERE id=?",
        {changes_.now_ms(), id}));
    if (!executor.empty()) {
      const std::int64_t attempt = job.attempts + 1;
      const auto folder = (runs.empty() ? layout_.runs() : runs) / run_name(id, attempt);
      HP_RETURN_IF_ERROR(insert_execution(database_, {id, attempt, executor, "", folder}));
    }
    return changes_.set_state(id, JobState::kRunning, "");
  });
  if (!started && started.error().reason == ErrorReason::DISK_FULL) discard_unowned(id);
  return started;
}

Status JobStore::report(std::int64_t id, const Progress& progress) {
  return changes_.transaction([&]() -> Status {
    HP_RETURN_IF_ERROR(
        database_.run("UPDATE jobs SET fraction=?, phase=?, phase_fraction=?, eta_ms=?, "
                      "waits_for=?, update_ms=?, "
                      "version=version+1 WHERE id=? AND state=?",
                      {progress.fraction, progress.phase, progress.phase_fraction, progress.eta_ms,
                       progress.waits_for, changes_.now_ms(), id, number(JobState::kRunning)}));
    return database_.changes() == 0 ? Status() : changes_.add_event(id, EventKind::kProgress, "");
  });
}

Result<Job> JobStore::succeed(std::int64_t id, const std::vector<Artifact>& artifacts,
                              const std::optional<NewCalibration>& calibration) {
  return changes_.change(id, [&](const Job& job) -> Status {
    if (job.state == JobState::kCancelling) return changes_.finish(id, JobState::kCancelled, "");
    if (job.state != JobState::kRunning) return state_forbids(job, "only a running job can end");
    HP_RETURN_IF_ERROR(changes_.add_artifacts(id, artifacts));
    HP_RETURN_IF_ERROR(database_.run("UPDATE jobs SET fraction=1 WHERE id=?", {id}));
    if (!calibration) return changes_.finish(id, JobState::kSucceeded, "");
    HP_ASSIGN_OR_RETURN(const std::int64_t definition,
                        insert_calibration(database_, *calibration, changes_.now_ms()));
    return changes_.finish(id, JobState::kSucceeded, calibration_name(definition));
  });
}

Result<Job> JobStore::give_up(std::int64_t id, const JobFailure& failure) {
  return changes_.change(id, [&](const Job& job) -> Status {
    if (job.state == JobState::kCancelling) return changes_.finish(id, JobState::kCancelled, "");
    if (job.state != JobState::kRunning) return state_forbids(job, "only a running job can end");
    return changes_.finish_failed(id, failure);
  });
}

Result<Job> JobStore::interrupt(std::int64_t id, Interruption why) {
  return changes_.change(id, [&](const Job& job) -> Status {
    if (job.state != JobState::kRunning && job.state != JobState::kCancelling) {
      return state_forbids(job, "only a running job can be interrupted");
    }
    return interrupt_open(changes_, job, why);
  });
}

Status JobStore::interrupt_all(Interruption why, const std::vector<Execution>& kept) {
  const auto is_kept = [&](std::int64_t id) {
    return std::any_of(kept.begin(), kept.end(),
                       [&](const Execution& execution) { return execution.job == id; });
  };
  return changes_.transaction([&]() -> Status {
    for (const JobState state :
         {JobState::kCancelling, JobState::kWaitingForOperator, JobState::kRunning}) {
      HP_ASSIGN_OR_RETURN(const auto ids, ids_in_state(state));
      for (const std::int64_t id : ids) {
        if (is_kept(id)) continue;
        HP_ASSIGN_OR_RETURN(const Job job, select_job(database_, id));
        HP_RETURN_IF_ERROR(interrupt_open(changes_, job, why));
      }
    }
    return {};
  });
}

Result<std::vector<Artifact>> JobStore::artifacts(std::int64_t id, const std::string& after,
                                                  int limit) {
  HP_RETURN_IF_ERROR(get(id));
  return select_artifacts(database_, "WHERE job=? AND name>? ORDER BY name LIMIT ?",
                          {id, after, std::int64_t{limit}});
}

Result<Artifact> JobStore::artifact(std::int64_t id, const std::string& name) {
  HP_RETURN_IF_ERROR(get(id));
  HP_ASSIGN_OR_RETURN(const auto found,
                      select_artifacts(database_, "WHERE job=? AND name=?", {id, name}));
  if (found.empty()) {
    return fail(Code::kNotFound, job_name(id) + " has no artifact \"" + name + "\"",
                ErrorReason::ARTIFACT_NOT_FOUND);
  }
  return found.front();
}

Result<Artifact> JobStore::sound_artifact(std::int64_t id, const std::string& name,
                                          const std::function<bool()>& is_cancelled) {
  HP_ASSIGN_OR_RETURN(Artifact file, artifact(id, name));
  HP_RETURN_IF_ERROR(check_file(id, file, is_cancelled));
  return file;
}

Status JobStore::check_file(std::int64_t job, const Artifact& file,
                            const std::function<bool()>& is_cancelled) {
  const auto path = layout_.artifacts(job) / file.name;
  const auto hash = hashes_.of(path, is_cancelled);
  if (!hash && hash.error().code == Code::kCancelled) return tl::unexpected(hash.error());
  std::error_code ignored;
  const bool is_sound = hash == file.sha256 && std::filesystem::file_size(path, ignored) ==
                                                   static_cast<std::uintmax_t>(file.size_bytes);
  if (is_sound) return {};
  log(LogLevel::kError, "artifact_damaged", {{"job", job}, {"file", file.name}});
  return fail(
      Code::kDataLoss,
      fmt::format("{}/artifacts/{}: the file is damaged or missing; retry the job (hydroprint "
                  "retry {}), or restore a backup",
                  job_name(job), file.name, job),
      ErrorReason::ARTIFACT_DAMAGED);
}

Status JobStore::check_was_given(std::int64_t seq) {
  HP_ASSIGN_OR_RETURN(const std::int64_t newest, last_seq());
  if (seq >= 0 && seq <= newest) return {};
  return fail(Code::kOutOfRange,
              fmt::format("after_seq: event {} does not exist in this store; get the job again and "
                          "watch without after_seq",
                          seq),
              ErrorReason::EVENTS_GONE);
}

Result<std::vector<JobEvent>> JobStore::all_events(std::int64_t after_seq, int limit) {
  HP_RETURN_IF_ERROR(check_was_given(after_seq));
  return select_events(database_, "WHERE seq>? ORDER BY seq LIMIT ?",
                       {after_seq, std::int64_t{limit}});
}

Result<std::vector<JobEvent>> JobStore::events(std::int64_t id, std::int64_t after_seq, int limit) {
  HP_RETURN_IF_ERROR(check_was_given(after_seq));
  return select_events(database_, "WHERE job=? AND seq>? ORDER BY seq LIMIT ?",
                       {id, after_seq, std::int64_t{limit}});
}

Result<std::int64_t> JobStore::last_seq() {
  // The newest number is returned even if its event was deleted.
  HP_ASSIGN_OR_RETURN(
      const auto newest,
      select_numbers(database_, "SELECT seq FROM sqlite_sequence WHERE name='events'", {}));
  return newest.empty() ? 0 : newest.front();
}

Result<std::vector<std::int64_t>> JobStore::ids_in_state(JobState state) {
  return select_numbers(database_, "SELECT id FROM jobs WHERE state=? ORDER BY id",
                        {number(state)});
}

}  // namespace hydroprint::daemon
