#include "daemon/workers/worker_pool.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

#include "daemon/platform/log.h"
#include "daemon/workers/fair_scheduler.h"
#include "daemon/workers/program_digest.h"

namespace hydroprint::daemon {
namespace {

constexpr int kTick_ms = 200;
constexpr int kIdleTick_ms = 5000;

}  // namespace

struct WorkerPool::Impl {
  Impl(const PoolOptions& o, WorkerExecutor& e, JobStore& s, JobQueue& q, const Layout& l, Clock c,
       std::chrono::milliseconds silence)
      : options(o),
        limits{std::chrono::seconds(o.time_limit_s), silence, output_limits(o)},
        executor(e),
        store(s),
        queue(q),
        layout(l),
        clock(std::move(c)),
        program(o.program) {}

  void loop();
  void wait_for_something() const;
  void cancel_asked();
  void start_jobs();
  [[nodiscard]] bool is_ready();
  bool start_next();
  void start_job(const Job& job);
  [[nodiscard]] Status start_worker(const Job& job);
  [[nodiscard]] Status resume_open();
  [[nodiscard]] RunContext context();
  void give_up_unstarted();
  [[nodiscard]] int threads_for(const Job& job) const;
  [[nodiscard]] Observations observe() const;
  void step_runs();
  void stop_all();
  [[nodiscard]] std::map<std::string, int> running_by_owner() const;

  PoolOptions options;
  RunLimits limits;
  WorkerExecutor& executor;
  JobStore& store;
  JobQueue& queue;
  Layout layout;
  Clock clock;
  ProgramDigest program;
  UniqueFd notifier{::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  std::vector<std::unique_ptr<WorkerRun>> runs;  // used only by the pool's thread
  bool has_resumed = false;
  std::vector<std::pair<std::int64_t, JobFailure>> unstarted;
  std::atomic<bool> stopping{false};
  mutable std::mutex turns_mutex;  // protects the next three members
  FairScheduler turns;
  std::map<std::string, int> running;
  std::string unready;  // why no job can start; empty: they can
  std::thread thread;
};

WorkerPool::WorkerPool() = default;

Result<std::unique_ptr<WorkerPool>> WorkerPool::make(const PoolOptions& options,
                                                     WorkerExecutor& executor, JobStore& store,
                                                     JobQueue& queue, const Layout& layout,
                                                     Clock clock,
                                                     std::chrono::milliseconds silence) {
  std::unique_ptr<WorkerPool> pool(new WorkerPool);
  pool->impl_ =
      std::make_unique<Impl>(options, executor, store, queue, layout, std::move(clock), silence);
  HP_RETURN_IF_ERROR(pool->impl_->program.get());
  return pool;
}

WorkerPool::~WorkerPool() { stop(); }

void WorkerPool::stop() {
  if (!impl_ || !impl_->thread.joinable()) return;
  impl_->stopping = true;
  wake();
  impl_->thread.join();
}

Result<NewJob> WorkerPool::with_digest(const JobRequest& request) const {
  HP_ASSIGN_OR_RETURN(const std::string worker, impl_->program.get());
  NewJob definition = request.definition;
  definition.digest = input_digest(definition.work, worker);
  return definition;
}

Result<Job> WorkerPool::check(const JobRequest& request) {
  HP_RETURN_IF_ERROR(impl_->store.check_inputs(request.definition.work.inputs));
  Job job;
  HP_ASSIGN_OR_RETURN(job.definition, with_digest(request));
  return job;
}

Result<Job> WorkerPool::create(const JobRequest& request) {
  HP_ASSIGN_OR_RETURN(const NewJob definition, with_digest(request));
  HP_ASSIGN_OR_RETURN(Job job, impl_->store.create(definition, request.key));
  wake();
  return job;
}

Result<Job> WorkerPool::cancel(std::int64_t id) {
  auto job = impl_->store.cancel(id);
  wake();
  return job;
}

void WorkerPool::start() {
  impl_->thread = std::thread([this] { impl_->loop(); });
}

void WorkerPool::wake() {
  const std::uint64_t one = 1;
  // Fails only if the counter is full, and then the thread is awake anyway.
  if (::write(impl_->notifier.get(), &one, sizeof one) < 0) return;
}

int WorkerPool::slots() const { return impl_->executor.capacity(); }

const PoolOptions& WorkerPool::options() const { return impl_->options; }

std::string WorkerPool::blocked_reason() const {
  const std::lock_guard lock(impl_->turns_mutex);
  return impl_->unready;
}

Result<std::vector<std::int64_t>> WorkerPool::order(std::size_t limit) const {
  HP_ASSIGN_OR_RETURN(const auto waiting, impl_->queue.waiting());
  const std::lock_guard lock(impl_->turns_mutex);
  return impl_->turns.order(waiting, impl_->running, limit);
}

void WorkerPool::Impl::loop() {
  while (!stopping) {
    cancel_asked();
    start_jobs();
    wait_for_something();
    step_runs();
  }
  stop_all();
}

void WorkerPool::Impl::wait_for_something() const {
  std::vector<pollfd> fds{{notifier.get(), POLLIN, 0}};
  for (const int fd : executor.descriptors()) fds.push_back({fd, POLLIN, 0});
  ::poll(fds.data(), fds.size(), runs.empty() ? kIdleTick_ms : kTick_ms);
  std::uint64_t wakeups = 0;
  // Fails if poll() ended for another reason.
  if (::read(notifier.get(), &wakeups, sizeof wakeups) < 0) return;
}

void WorkerPool::Impl::cancel_asked() {
  if (runs.empty()) return;
  const auto ids = store.ids_in_state(JobState::kCancelling);
  if (!ids) return;
  for (const auto& run : runs) {
    if (std::find(ids->begin(), ids->end(), run->execution().job) != ids->end()) {
      run->stop(StopReason::kCancel);
    }
  }
}

void WorkerPool::Impl::start_jobs() {
  if (const Status resumed = resume_open(); !resumed) {
    log(LogLevel::kError, "jobs_not_resumed", {{"message", resumed.error().message}});
    return;
  }
  while (!stopping && runs.size() < static_cast<std::size_t>(executor.capacity()) && is_ready() &&
         start_next()) {
  }
}

// Returns whether the executor takes executions now. Jobs stay in the queue until it does.
bool WorkerPool::Impl::is_ready() {
  const Status ready = executor.ready();
  const std::string why = ready ? "" : ready.error().message;
  const std::lock_guard lock(turns_mutex);
  if (why != unready) {
    log(ready ? LogLevel::kInfo : LogLevel::kError, ready ? "jobs_start_again" : "jobs_wait",
        {{"message", why}});
  }
  unready = why;
  return ready.has_value();
}

// Continues the executions of an earlier daemon, once.
Status WorkerPool::Impl::resume_open() {
  if (has_resumed) return {};
  HP_ASSIGN_OR_RETURN(const auto open, store.executions());
  std::vector<std::unique_ptr<WorkerRun>> resumed;
  for (const Execution& execution : open) {
    HP_ASSIGN_OR_RETURN(const Job job, store.get(execution.job));
    resumed.push_back(WorkerRun::resume(job, execution, context()));
  }
  runs = std::move(resumed);
  has_resumed = true;
  return {};
}

RunContext WorkerPool::Impl::context() {
  return {executor, layout, limits, [this] {
            const std::uint64_t one = 1;
            if (::write(notifier.get(), &one, sizeof one) < 0) return;
          }};
}

std::map<std::string, int> WorkerPool::Impl::running_by_owner() const {
  std::map<std::string, int> out;
  for (const auto& run : runs) ++out[run->owner()];
  return out;
}

// Starts the next job, if any. Returns true if another job may be started.
bool WorkerPool::Impl::start_next() {
  const auto pause = queue.pause();
  const auto waiting = queue.waiting();
  if (!pause || pause->paused || !waiting || waiting->empty()) return false;
  std::vector<std::int64_t> next;
  {
    const std::lock_guard lock(turns_mutex);
    running = running_by_owner();
    next = turns.order(*waiting, running, 1);
  }
  const auto job = store.start(next.front(), executor.name(), executor.runs(layout));
  if (!job) {
    log(LogLevel::kError, "job_not_started",
        {{"job", next.front()}, {"message", job.error().message}});
    // If the job was just cancelled or deleted, try the next one. After a store error, wait for the
    // next wake-up.
    return job.error().code == Code::kFailedPrecondition || job.error().code == Code::kNotFound;
  }
  {
    const std::lock_guard lock(turns_mutex);
    turns.served(job->definition.owner);
  }
  if (job->state == JobState::kRunning) start_job(*job);
  const std::lock_guard lock(turns_mutex);
  running = running_by_owner();
  return true;
}

void WorkerPool::Impl::start_job(const Job& job) {
  const Status status = start_worker(job);
  if (status) return;
  discard(executor.runs(layout) / run_name(job.id, job.attempts));
  log(LogLevel::kError, "worker_not_started",
      {{"job", job.id}, {"message", status.error().message}});
  unstarted.push_back({job.id, {status.error(), {}, {}}});
  give_up_unstarted();
}

Status WorkerPool::Impl::start_worker(const Job& job) {
  const RunFolder folder{executor.runs(layout) / run_name(job.id, job.attempts)};
  HP_RETURN_IF_ERROR(make_run_folder(job, folder));
  const Execution execution{job.id, job.attempts, executor.name(), "", folder.root};
  Launch launch = worker_launch(job, folder, options, threads_for(job));
  HP_ASSIGN_OR_RETURN(launch.build_id, program.get());
  HP_ASSIGN_OR_RETURN(auto run, WorkerRun::start(job, execution, launch, context()));
  runs.push_back(std::move(run));
  return {};
}

// Stores the failure of jobs whose worker could not be started. If the store fails, every step
// tries this again.
void WorkerPool::Impl::give_up_unstarted() {
  std::erase_if(unstarted, [&](const auto& entry) {
    const auto ended = store.give_up(entry.first, entry.second);
    return ended || ended.error().code == Code::kFailedPrecondition ||
           ended.error().code == Code::kNotFound;
  });
}

int WorkerPool::Impl::threads_for(const Job& job) const {
  if (job.definition.threads > 0) return job.definition.threads;
  if (options.threads > 0) return options.threads;
  // A single job gets all cores; otherwise the cores are divided among running and waiting jobs.
  const auto waiting = queue.waiting();
  const int there =
      static_cast<int>(runs.size()) + 1 + static_cast<int>(waiting ? waiting->size() : 0);
  return std::max(1, options.cores / std::clamp(there, 1, executor.capacity()));
}

Observations WorkerPool::Impl::observe() const {
  std::vector<Execution> open;
  for (const auto& run : runs) {
    if (run->is_open()) open.push_back(run->execution());
  }
  return executor.poll(open);
}

void WorkerPool::Impl::step_runs() {
  const std::int64_t now_ms = clock();
  give_up_unstarted();
  const Observations seen = observe();
  std::erase_if(runs, [&](const auto& run) {
    return run->step(of_job(seen, run->execution().job), store, now_ms);
  });
  const std::lock_guard lock(turns_mutex);
  running = running_by_owner();
}

void WorkerPool::Impl::stop_all() {
  std::erase_if(runs, [](const auto& run) { return run->outlives_daemon(); });
  for (const auto& run : runs) run->stop(StopReason::kShutdown);
  while (!runs.empty()) {
    wait_for_something();
    step_runs();
  }
}

}  // namespace hydroprint::daemon
