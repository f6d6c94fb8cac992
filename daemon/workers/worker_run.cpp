#include "daemon/workers/worker_run.h"

#include <signal.h>

#include "daemon/jobs/registry.h"
#include "daemon/platform/log.h"

namespace hydroprint::daemon {
namespace {

using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

constexpr std::chrono::seconds kGrace{3};
// Reports are limited because each is a transaction on disk.
constexpr milliseconds kReportInterval{250};
constexpr std::chrono::seconds kTryAgainAfter{1};
constexpr std::size_t kWordsKept = 16 << 10;
constexpr std::size_t kLongestLine = 4 << 10;

// Returns whether a retry cannot help, because the job has changed or is gone.
bool is_settled(const Error& error) {
  return error.code == Code::kFailedPrecondition || error.code == Code::kNotFound;
}

}  // namespace

Result<std::unique_ptr<WorkerRun>> WorkerRun::start(const Job& job, const Launch& launch_plan,
                                                    const Layout& layout,
                                                    std::chrono::seconds time_limit,
                                                    std::function<void()> wake) {
  std::unique_ptr<WorkerRun> run(new WorkerRun(job, layout));
  run->wake_ = std::move(wake);
  HP_RETURN_IF_ERROR(lay_out_inputs(layout, job.definition.work.inputs, launch_plan.inputs));
  HP_ASSIGN_OR_RETURN(run->worker_, launch(launch_plan));
  run->memory_bytes_ = launch_plan.limits.memory_bytes;
  run->deadline_ = SteadyClock::now() + time_limit;
  log(LogLevel::kInfo, "job_started",
      {{"job", job.id},
       {"owner", job.definition.owner},
       {"verb", job.definition.work.verb},
       {"pid", std::int64_t{run->worker_.pid}}});
  return run;
}

WorkerRun::~WorkerRun() {
  if (!wait_status_) kill_and_wait(worker_);
  if (publishing_.valid()) publishing_.wait();
  discard(layout_.run(job_.id));
}

std::vector<int> WorkerRun::descriptors() const {
  std::vector<int> out;
  for (const UniqueFd* fd :
       {&worker_.handle, &worker_.progress, &worker_.errors, &worker_.answer}) {
    if (fd->valid()) out.push_back(fd->get());
  }
  return out;
}

bool WorkerRun::step(JobStore& store, std::int64_t now_ms) {
  if (wait_status_) return finish(store);
  read_words();
  read_progress_lines(store, now_ms);
  watch_limits();
  if (!reap()) return false;
  if (stopped_ == StopReason::kNothing && !judge(*wait_status_, stopped_, words_, answer_)) {
    begin_publishing();
  }
  return finish(store);
}

void WorkerRun::stop(StopReason why) {
  if (stopped_ != StopReason::kNothing) {
    if (why == StopReason::kShutdown) stopped_ = why;
    return;
  }
  stopped_ = why;
  kill_at_ = SteadyClock::now() + kGrace;
  if (!wait_status_) signal_group(worker_, SIGTERM);
}

void WorkerRun::read_words() {
  const auto read = [](UniqueFd& pipe, std::string& words) {
    if (!pipe.valid()) return;
    if (!drain(pipe, words, 1 << 20)) pipe.reset();
    if (words.size() > kWordsKept) words.erase(0, words.size() - kWordsKept);
  };
  read(worker_.errors, words_);
  read(worker_.answer, answer_);
}

void WorkerRun::read_progress_lines(JobStore& store, std::int64_t now_ms) {
  if (worker_.progress.valid() && !drain(worker_.progress, progress_bytes_, 1 << 20)) {
    worker_.progress.reset();
  }
  std::size_t begin = 0;
  for (std::size_t end = 0; (end = progress_bytes_.find('\n', begin)) != std::string::npos;
       begin = end + 1) {
    const std::string_view line(progress_bytes_.data() + begin, end - begin);
    if (line.size() > kLongestLine) continue;
    if (auto progress = read_progress(line, now_ms)) progress_ = std::move(progress);
  }
  progress_bytes_.erase(0, begin);
  if (progress_bytes_.size() > kLongestLine) progress_bytes_.clear();
  report(store);
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
  if (now >= deadline_) stop(StopReason::kTime);
  if (memory_bytes_ > 0 && stopped_ == StopReason::kNothing &&
      resident_bytes(worker_) > memory_bytes_) {
    stop(StopReason::kMemory);
    kill_at_ = now;  // no grace period, because the worker might use even more memory
  }
  if (kill_at_ && now >= *kill_at_) signal_group(worker_, SIGKILL);
}

// Once the worker has ended, kills its children and returns true.
bool WorkerRun::reap() {
  const auto status = wait_for_end(worker_);
  if (!status) return false;
  signal_group(worker_, SIGKILL);
  read_words();
  wait_status_ = status;
  worker_.handle.reset();
  worker_.progress.reset();
  worker_.errors.reset();
  worker_.answer.reset();
  return true;
}

Result<WorkerRun::Outcome> WorkerRun::publish() const {
  Outcome out;
  HP_ASSIGN_OR_RETURN(out.artifacts,
                      publish_artifacts(layout_.run_out(job_.id), layout_.artifacts(job_.id)));
  HP_ASSIGN_OR_RETURN(const JobKind* const kind, kind_of(job_));
  HP_ASSIGN_OR_RETURN(out.calibration, kind->calibration(job_, layout_.artifacts(job_.id)));
  return out;
}

// Publishes in a separate thread, because other jobs need the pool's thread while large files are
// hashed and synced.
void WorkerRun::begin_publishing() {
  publishing_ = std::async(std::launch::async, [this] {
    auto result = publish();
    wake_();
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
  if (error.reason != "DISK_FULL" || !published_ || !*published_) return;
  published_ = tl::unexpected(error);
  next_end_ = {};
}

// Deletes the output of a failed worker before the end of its job is stored, because the output may
// have filled the disk.
void WorkerRun::discard_output() const {
  discard(layout_.run(job_.id));
  discard(layout_.artifacts(job_.id));
}

Result<Job> WorkerRun::store_end(JobStore& store) const {
  if (published_ && *published_) {
    return store.succeed(job_.id, (*published_)->artifacts, (*published_)->calibration);
  }
  if (published_) return store.give_up(job_.id, {published_->error(), {}, {}});
  const JobFailure cancelled{{Code::kCancelled, "cancelled", "", {}}, {}, {}};
  return store.give_up(job_.id,
                       judge(*wait_status_, stopped_, words_, answer_).value_or(cancelled));
}

void WorkerRun::log_end(const Result<Job>& job) const {
  if (!job) {
    log(LogLevel::kError, "job_end_lost", {{"job", job_.id}, {"message", job.error().message}});
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
