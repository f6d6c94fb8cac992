#include "daemon/workers/worker_pool.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

#include "daemon/platform/log.h"
#include "daemon/workers/fair_scheduler.h"
#include "daemon/workers/worker_run.h"

namespace hydroprint::daemon {
namespace {

constexpr int kTick_ms = 200;
constexpr int kIdleTick_ms = 5000;

// The hash of the program, recomputed only when the file has changed.
class ProgramDigest {
 public:
  explicit ProgramDigest(std::filesystem::path path) : path_(std::move(path)) {}

  Result<std::string> get() {
    const std::lock_guard lock(mutex_);
    struct stat info {};
    if (::stat(path_.c_str(), &info) != 0) {
      return fail(Code::kInternal,
                  path_.string() + ": the worker program does not exist; check workers.program",
                  "WORKER_UNUSABLE");
    }
    const std::string stamp = fmt::format("{} {} {}.{}", info.st_ino, info.st_size,
                                          info.st_mtim.tv_sec, info.st_mtim.tv_nsec);
    if (stamp != stamp_) {
      HP_ASSIGN_OR_RETURN(digest_, sha256_of_file(path_));
      stamp_ = stamp;
    }
    return digest_;
  }

 private:
  std::mutex mutex_;
  std::filesystem::path path_;
  std::string stamp_, digest_;
};

}  // namespace

struct WorkerPool::Impl {
  Impl(const PoolOptions& o, JobStore& s, JobQueue& q, const Layout& l, Clock c)
      : options(o), store(s), queue(q), layout(l), clock(std::move(c)), program(o.program) {}

  void loop();
  void wait_for_something() const;
  void cancel_asked();
  void start_jobs();
  bool start_next();
  void start_job(const Job& job);
  [[nodiscard]] Status start_worker(const Job& job);
  [[nodiscard]] Status make_run_folder(const Job& job) const;
  [[nodiscard]] std::vector<std::string> options_of(const Job& job) const;
  void give_up_unstarted();
  [[nodiscard]] Launch plan(const Job& job) const;
  void step_runs();
  void stop_all();
  [[nodiscard]] std::map<std::string, int> running_by_owner() const;

  PoolOptions options;
  JobStore& store;
  JobQueue& queue;
  Layout layout;
  Clock clock;
  ProgramDigest program;
  UniqueFd notifier{::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  std::vector<std::unique_ptr<WorkerRun>> runs;  // used only by the pool's thread
  std::vector<std::pair<std::int64_t, JobFailure>> unstarted;
  std::atomic<bool> stopping{false};
  mutable std::mutex turns_mutex;  // protects the next two members
  FairScheduler turns;
  std::map<std::string, int> running;
  std::thread thread;
};

WorkerPool::WorkerPool() = default;

Result<std::unique_ptr<WorkerPool>> WorkerPool::make(const PoolOptions& options, JobStore& store,
                                                     JobQueue& queue, const Layout& layout,
                                                     Clock clock) {
  HP_RETURN_IF_ERROR(check_confinement(options.confine_program));
  std::unique_ptr<WorkerPool> pool(new WorkerPool);
  pool->impl_ = std::make_unique<Impl>(options, store, queue, layout, std::move(clock));
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

int WorkerPool::slots() const { return impl_->options.slots; }

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
  for (const auto& run : runs) {
    for (const int fd : run->descriptors()) fds.push_back({fd, POLLIN, 0});
  }
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
    if (std::find(ids->begin(), ids->end(), run->job()) != ids->end()) {
      run->stop(StopReason::kCancel);
    }
  }
}

void WorkerPool::Impl::start_jobs() {
  while (runs.size() < static_cast<std::size_t>(options.slots) && start_next()) {
  }
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
  const auto job = store.start(next.front());
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
  discard(layout.run(job.id));
  log(LogLevel::kError, "worker_not_started",
      {{"job", job.id}, {"message", status.error().message}});
  unstarted.push_back({job.id, {status.error(), {}, {}}});
  give_up_unstarted();
}

Status WorkerPool::Impl::start_worker(const Job& job) {
  HP_RETURN_IF_ERROR(make_run_folder(job));
  const auto wake = [this] {
    const std::uint64_t one = 1;
    if (::write(notifier.get(), &one, sizeof one) < 0) return;
  };
  HP_ASSIGN_OR_RETURN(auto run, WorkerRun::start(job, plan(job), layout,
                                                 std::chrono::seconds(options.time_limit_s), wake));
  runs.push_back(std::move(run));
  return {};
}

Status WorkerPool::Impl::make_run_folder(const Job& job) const {
  const Work& work = job.definition.work;
  HP_RETURN_IF_ERROR(make_folder(layout.run_work(job.id)));
  if (!work.spec.empty()) return write_file(layout.run_spec(job.id), work.spec);
  return work.pose_json.empty() ? Status() : write_file(layout.run_pose(job.id), work.pose_json);
}

/// Returns the job's options: its spec, or its flags if an earlier version of the daemon stored it.
std::vector<std::string> WorkerPool::Impl::options_of(const Job& job) const {
  const Work& work = job.definition.work;
  if (!work.spec.empty()) return spec_options(layout.run_spec(job.id));
  std::vector<std::string> out = work.flags;
  if (!work.pose_json.empty()) out.push_back("--pose=" + layout.run_pose(job.id).string());
  return out;
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

Launch WorkerPool::Impl::plan(const Job& job) const {
  // A single job gets all cores; otherwise the cores are divided among running and waiting jobs.
  const auto waiting = queue.waiting();
  const int there =
      static_cast<int>(runs.size()) + 1 + static_cast<int>(waiting ? waiting->size() : 0);
  const int shared = std::max(1, options.cores / std::clamp(there, 1, options.slots));
  const int threads = job.definition.threads > 0 ? job.definition.threads
                      : options.threads > 0      ? options.threads
                                                 : shared;
  Launch launch;
  launch.program = options.program;
  launch.confine_program = options.confine_program;
  launch.inputs = layout.run_inputs(job.id);
  launch.work = layout.run_work(job.id);
  launch.arguments = {job.definition.work.verb};
  for (std::string& option : options_of(job)) launch.arguments.push_back(std::move(option));
  launch.arguments.push_back(fmt::format("--threads={}", threads));
  launch.arguments.push_back("--out=" + layout.run_out(job.id).string());
  launch.arguments.push_back(fmt::format("--progress-fd={}", kProgressFd));
  launch.arguments.emplace_back("--json");
  launch.limits = {options.memory_bytes,
                   options.time_limit_s * std::max(threads, options.cores) + 10,
                   options.file_bytes};
  return launch;
}

void WorkerPool::Impl::step_runs() {
  const std::int64_t now_ms = clock();
  give_up_unstarted();
  std::erase_if(runs, [&](const auto& run) { return run->step(store, now_ms); });
  const std::lock_guard lock(turns_mutex);
  running = running_by_owner();
}

void WorkerPool::Impl::stop_all() {
  for (const auto& run : runs) run->stop(StopReason::kShutdown);
  while (!runs.empty()) {
    wait_for_something();
    step_runs();
  }
}

}  // namespace hydroprint::daemon
