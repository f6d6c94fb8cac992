#include "daemon/workers/worker_run.h"

#include <fmt/format.h>
#include <signal.h>

#include "daemon/jobs/registry.h"
#include "daemon/jobs/report.h"
#include "daemon/platform/log.h"

namespace hydroprint::daemon {
namespace {

using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

constexpr std::chrono::seconds kGrace{3};
// Reports are limited because each is a transaction on disk.
constexpr milliseconds kReportInterval{250};
constexpr std::chrono::seconds kTryAgainAfter{1};

// Returns whether a retry cannot help, because the job has changed or is gone.
bool is_settled(const Error& error) {
  return error.code == Code::kFailedPrecondition || error.code == Code::kNotFound;
}

JobFailure silence_failure(const Execution& execution, milliseconds silence) {
  return {{Code::kInternal,
           fmt::format("the executor \"{}\" did not answer for {} minutes, so it is unknown "
                       "whether the job still runs there; check that it works, and retry the job",
                       execution.executor,
                       std::chrono::duration_cast<std::chrono::minutes>(silence).count()),
           ErrorReason::WORKER_UNUSABLE,
           {}},
          {},
          {}};
}

tl::unexpected<Error> unusable_report(const Error& why) {
  return fail(Code::kInternal,
              fmt::format("the worker's report cannot be used: {}; check that workers.program is "
                          "hydroprint-worker",
                          why.message),
              ErrorReason::WORKER_UNUSABLE);
}

}  // namespace

WorkerRun::WorkerRun(const Job& job, Execution execution, RunContext context)
    : job_(job),
      execution_(std::move(execution)),
      context_(std::move(context)),
      folder_{execution_.folder},
      last_answer_(SteadyClock::now()) {}

Result<std::unique_ptr<WorkerRun>> WorkerRun::start(const Job& job, Execution execution,
                                                    const Launch& launch, RunContext context) {
  std::unique_ptr<WorkerRun> run(new WorkerRun(job, std::move(execution), std::move(context)));
  run->launch_ = launch;
  if (!run->is_on_state_disk()) {
    run->begin_copying();
    return run;
  }
  HP_RETURN_IF_ERROR(
      lay_out_inputs(run->context_.layout, job.definition.work.inputs, launch.inputs));
  HP_RETURN_IF_ERROR(run->start_worker());
  return run;
}

std::unique_ptr<WorkerRun> WorkerRun::resume(const Job& job, const Execution& execution,
                                             RunContext context) {
  std::unique_ptr<WorkerRun> run(new WorkerRun(job, execution, std::move(context)));
  run->phase_ = Phase::kOffered;
  return run;
}

WorkerRun::~WorkerRun() {
  files_stop_.request_stop();
  if (copying_.valid()) copying_.wait();
  if (publishing_.valid()) publishing_.wait();
  if (is_over_) discard(folder_.root);
}

bool WorkerRun::outlives_daemon() const {
  return !is_executors_own() || context_.executor.outlives_daemon();
}

bool WorkerRun::is_on_state_disk() const {
  return folder_.root.parent_path() == context_.layout.runs();
}

bool WorkerRun::is_executors_own() const { return execution_.executor == context_.executor.name(); }

bool WorkerRun::step(const std::optional<Observation>& seen, JobStore& store, std::int64_t now_ms) {
  if (is_unended()) watch(seen, store, now_ms);
  if (is_unended()) return false;
  is_over_ = finish(store);
  return is_over_;
}

void WorkerRun::watch(const std::optional<Observation>& seen, JobStore& store,
                      std::int64_t now_ms) {
  if (phase_ == Phase::kCopying) {
    await_inputs();
  } else if (phase_ == Phase::kOffered) {
    offer_again();
  } else if (seen) {
    judge_observation(*seen, now_ms);
  }
  if (phase_ == Phase::kOpen && !is_noted_) note_handle(store);
  report(store);
  if (is_unended()) watch_limits();
}

// Copies the inputs in a separate thread: a network may be slow, and other jobs need the pool's
// thread.
void WorkerRun::begin_copying() {
  phase_ = Phase::kCopying;
  progress_ = waiting_progress("its files are copied");
  copying_ = std::async(std::launch::async, [this, stop = files_stop_.get_token()] {
    Status copied =
        lay_out_inputs(context_.layout, job_.definition.work.inputs, launch_.inputs, stop);
    context_.wake();
    return copied;
  });
}

// Starts the worker when its inputs are there.
void WorkerRun::await_inputs() {
  if (stopped_ != StopReason::kNothing) {
    files_stop_.request_stop();
    return take_end({.wait_status = SIGKILL});
  }
  last_answer_ = SteadyClock::now();  // the executor was not asked anything
  if (copying_.wait_for(milliseconds(0)) != std::future_status::ready) return;
  Status started = copying_.get();
  if (started) started = start_worker();
  if (started) return;
  phase_ = Phase::kEnded;
  published_ = tl::unexpected(started.error());
}

Status WorkerRun::start_worker() {
  HP_ASSIGN_OR_RETURN(execution_.handle, context_.executor.start(execution_, launch_));
  phase_ = Phase::kOpen;
  is_noted_ = !context_.executor.outlives_daemon();  // then no later daemon needs the handle
  log(LogLevel::kInfo, "job_started",
      {{"job", job_.id},
       {"owner", owner()},
       {"verb", job_.definition.work.verb},
       {"executor", execution_.executor},
       {"handle", execution_.handle}});
  return {};
}

void WorkerRun::note_handle(JobStore& store) {
  is_noted_ = true;  // without it, the executor finds the execution by its folder
  if (const Status noted = store.note_handle(execution_); !noted) {
    log(LogLevel::kError, "handle_lost", {{"job", job_.id}, {"message", noted.error().message}});
  }
}

void WorkerRun::stop(StopReason why) {
  if (stopped_ != StopReason::kNothing) {
    if (why == StopReason::kShutdown) stopped_ = why;
    return;
  }
  stopped_ = why;
  if (is_unended()) return ask_for_end();
  files_stop_.request_stop();
}

void WorkerRun::offer_again() {
  const auto now = SteadyClock::now();
  if (now < next_offer_) return;
  next_offer_ = now + kTryAgainAfter;
  const Adoption answer = offer(context_.executor, execution_);
  if (answer == Adoption::kNoAnswer) return;
  last_answer_ = now;
  if (answer == Adoption::kGone) return lose(Interruption::kLoss);
  phase_ = Phase::kOpen;
  log(LogLevel::kInfo, "job_adopted",
      {{"job", job_.id}, {"executor", execution_.executor}, {"handle", execution_.handle}});
}

void WorkerRun::judge_observation(const Observation& seen, std::int64_t now_ms) {
  last_answer_ = SteadyClock::now();
  if (const auto* waits = std::get_if<WorkerWaits>(&seen)) {
    if (waits->reason != waiting_reason_) progress_ = waiting_progress(waits->reason);
    waiting_reason_ = waits->reason;
  } else if (const auto* runs = std::get_if<WorkerRuns>(&seen)) {
    if (!deadline_) deadline_ = last_answer_ + context_.limits.time;
    take_progress(runs->progress, now_ms);
  } else if (const auto* end = std::get_if<WorkerEnds>(&seen)) {
    take_progress(end->progress, now_ms);
    take_end(*end);
  } else if (stopped_ != StopReason::kNothing) {
    take_end({.wait_status = SIGKILL});  // it was asked to end
  } else {
    lose(Interruption::kWorkerLoss);
  }
}

void WorkerRun::take_progress(const std::vector<std::string>& lines, std::int64_t now_ms) {
  for (const std::string& line : lines) {
    if (auto progress = read_progress(line, now_ms)) progress_ = std::move(progress);
  }
}

void WorkerRun::take_end(const WorkerEnds& end) {
  phase_ = Phase::kEnded;
  end_ = end;
  // A worker that ended in time, while an engine did not answer, has succeeded.
  const bool has_succeeded = end.wait_status == 0;
  if (stopped_ == StopReason::kTime && has_succeeded) stopped_ = StopReason::kNothing;
  if (stopped_ != StopReason::kNothing) return;
  if (!has_succeeded && (end.exceeded_memory || end.exceeded_time || end.exceeded_output)) {
    stopped_ = end.exceeded_memory   ? StopReason::kMemory
               : end.exceeded_output ? StopReason::kOutput
                                     : StopReason::kTime;
  } else if (!judge(end.wait_status, stopped_, end.errors, end.answer)) {
    begin_publishing();
  }
}

void WorkerRun::lose(Interruption why) {
  phase_ = Phase::kLost;
  loss_ = why;
}

void WorkerRun::report(JobStore& store) {
  const auto now = SteadyClock::now();
  if (!progress_ || now < next_report_) return;
  next_report_ = now + kReportInterval;
  if (const Status status = store.report(job_.id, *progress_); !status) {
    log(LogLevel::kError, "progress_lost", {{"job", job_.id}, {"message", status.error().message}});
  }
  progress_.reset();
}

void WorkerRun::watch_limits() {
  const auto now = SteadyClock::now();
  if (deadline_ && now >= *deadline_) stop(StopReason::kTime);
  if (stopped_ != StopReason::kNothing) ask_for_end();
  if (now - last_answer_ >= context_.limits.silence) phase_ = Phase::kSilent;
}

// Asks the executor, again each second until it answers, to end the worker; after a grace period at
// once.
void WorkerRun::ask_for_end() {
  const auto now = SteadyClock::now();
  if (now < next_cancel_ || !is_executors_own() || phase_ == Phase::kCopying) return;
  next_cancel_ = now + kTryAgainAfter;
  const CancelHow how = kill_at_ ? CancelHow::kAtOnce : CancelHow::kGently;
  if (!context_.executor.cancel(execution_, how) || how == CancelHow::kAtOnce) return;
  kill_at_ = now + kGrace;
  next_cancel_ = *kill_at_;
}

// Returns the folder for a copy of the output on the disk of the state folder, which nothing that
// the worker left behind on a node can change any more; empty if the output itself is there.
std::filesystem::path WorkerRun::output_copy() const {
  if (is_on_state_disk()) return {};
  return context_.layout.runs() / (folder_.root.filename().string() + ".output");
}

Result<WorkerRun::Outcome> WorkerRun::publish(const PublishOptions& options) const {
  Outcome out;
  const auto artifacts = context_.layout.artifacts(job_.id);
  // An earlier daemon may have been killed after it published them, before it stored the job's end.
  std::error_code ignored;
  const auto output = std::filesystem::symlink_status(folder_.out(), ignored);
  if (!std::filesystem::exists(output) && std::filesystem::exists(artifacts, ignored)) {
    HP_RETURN_IF_ERROR(hydroprint::daemon::publish(artifacts, folder_.out()));
  }
  HP_ASSIGN_OR_RETURN(out.artifacts, publish_artifacts(folder_.out(), artifacts, options));
  HP_ASSIGN_OR_RETURN(const JobKind* const kind, kind_of(job_));
  const auto report = read_report(artifacts, kind->name());
  if (!report) return unusable_report(report.error());
  HP_ASSIGN_OR_RETURN(out.calibration, kind->calibration(job_, *report));
  return out;
}

// Publishes in a separate thread, because other jobs need the pool's thread while large files are
// hashed and synced.
void WorkerRun::begin_publishing() {
  const OutputLimits& limits = context_.limits.output;
  PublishOptions options{folder_.root.parent_path(), output_copy(), limits,
                         SteadyClock::now() + publishing_time(limits), files_stop_.get_token()};
  publishing_ = std::async(std::launch::async, [this, options = std::move(options)] {
    auto result = publish(options);
    context_.wake();
    return result;
  });
}

bool WorkerRun::finish(JobStore& store) {
  if (stopped_ == StopReason::kShutdown) return true;
  if (publishing_.valid()) {
    if (publishing_.wait_for(milliseconds(0)) != std::future_status::ready) return false;
    published_ = publishing_.get();
  }
  if (SteadyClock::now() < next_end_) return false;
  if (!published_ || !*published_) discard_output();
  const auto ended = store_end(store);
  log_end(ended);
  if (!ended) {
    next_end_ = SteadyClock::now() + kTryAgainAfter;
    free_disk_for(ended.error());
    return is_settled(ended.error());
  }
  if (ended->state != JobState::kSucceeded) discard_output();
  return true;
}

// If the artifacts leave no space for their rows in the database, the job fails without artifacts.
void WorkerRun::free_disk_for(const Error& error) {
  if (error.reason != ErrorReason::DISK_FULL || !published_ || !*published_) return;
  published_ = tl::unexpected(error);
  next_end_ = {};
}

// Deletes the output of a failed worker before the end of its job is stored, because the output may
// have filled the disk.
void WorkerRun::discard_output() const {
  discard(folder_.root);
  discard(context_.layout.artifacts(job_.id));
  if (const auto copy = output_copy(); !copy.empty()) discard(copy);
}

Result<Job> WorkerRun::store_end(JobStore& store) const {
  if (phase_ == Phase::kLost) return store.interrupt(job_.id, loss_);
  if (phase_ == Phase::kSilent) {
    return store.give_up(job_.id, silence_failure(execution_, context_.limits.silence));
  }
  if (published_ && *published_) {
    return store.succeed(job_.id, (*published_)->artifacts, (*published_)->calibration);
  }
  if (published_) return store.give_up(job_.id, {published_->error(), {}, {}});
  const JobFailure cancelled{{Code::kCancelled, "cancelled"}, {}, {}};
  JobFailure failure =
      judge(end_.wait_status, stopped_, end_.errors, end_.answer).value_or(cancelled);
  const auto kind = kind_of(job_);
  if (std::string& field = failure.error.field; kind && !field.empty())  // of the spec
    field.insert(0, (*kind)->field().name() + ".");
  return store.give_up(job_.id, failure);
}

void WorkerRun::log_end(const Result<Job>& job) const {
  if (!job) {
    log(LogLevel::kError, "job_end_lost", {{"job", job_.id}, {"message", job.error().message}});
    return;
  }
  if (!is_finished(job->state)) {
    log(LogLevel::kWarning, "worker_lost", {{"job", job_.id}, {"state", name_of(job->state)}});
    return;
  }
  const std::string message = job->failure ? job->failure->error.message : "";
  log(LogLevel::kInfo, "job_ended",
      {{"job", job_.id},
       {"owner", owner()},
       {"state", name_of(job->state)},
       {"seconds", (job->end_ms - job->start_ms) / 1000},
       {"message", message}});
}

}  // namespace hydroprint::daemon
