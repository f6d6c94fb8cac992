#include "daemon/workers/local_executor.h"

#include <fmt/format.h>
#include <signal.h>

#include "daemon/workers/worker_outcome.h"

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kTailKept = 16 << 10;
constexpr std::size_t kReadAtOnce = 1 << 20;

}  // namespace

LocalExecutor::~LocalExecutor() {
  for (const auto& entry : workers_) kill_and_wait(entry.second.process);
}

Result<std::string> LocalExecutor::start(const Execution& execution, const Launch& launch_plan) {
  Worker worker;
  Launch with_progress = launch_plan;
  with_progress.arguments.push_back(fmt::format("--progress-fd={}", kProgressFd));
  HP_ASSIGN_OR_RETURN(worker.process, launch(with_progress));
  worker.memory_bytes = launch_plan.limits.memory_bytes;
  worker.most_written_bytes = launch_plan.written_bytes;
  const std::string pid = std::to_string(worker.process.pid);
  workers_.insert_or_assign(execution.job, std::move(worker));
  return pid;
}

Observations LocalExecutor::poll(const std::vector<Execution>& executions) {
  Observations out;
  for (const Execution& execution : executions) {
    const auto found = workers_.find(execution.job);
    if (found == workers_.end()) {
      out.emplace(execution.job, WorkerIsGone());
      continue;
    }
    Observation seen = observe(found->second);
    if (std::holds_alternative<WorkerEnds>(seen)) workers_.erase(found);
    out.emplace(execution.job, std::move(seen));
  }
  return out;
}

Status LocalExecutor::cancel(const Execution& execution, CancelHow how) {
  const auto found = workers_.find(execution.job);
  if (found != workers_.end()) {
    signal_group(found->second.process, how == CancelHow::kGently ? SIGTERM : SIGKILL);
  }
  return {};
}

Adoption LocalExecutor::adopt(const Execution& execution) {
  return workers_.contains(execution.job) ? Adoption::kAdopted : Adoption::kGone;
}

std::vector<int> LocalExecutor::descriptors() const {
  std::vector<int> out;
  for (const auto& [job, worker] : workers_) {
    const ChildProcess& process = worker.process;
    for (const UniqueFd* fd :
         {&process.handle, &process.progress, &process.errors, &process.answer}) {
      if (fd->valid()) out.push_back(fd->get());
    }
  }
  return out;
}

void LocalExecutor::read_words(Worker& worker) {
  const auto read = [](UniqueFd& pipe, std::string& words) {
    if (!pipe.valid()) return;
    if (!drain(pipe, words, kReadAtOnce)) pipe.reset();
    if (words.size() > kTailKept) words.erase(0, words.size() - kTailKept);
  };
  read(worker.process.errors, worker.errors);
  read(worker.process.answer, worker.answer);
}

std::vector<std::string> LocalExecutor::read_progress_lines(Worker& worker) {
  UniqueFd& pipe = worker.process.progress;
  if (pipe.valid() && !drain(pipe, worker.progress, kReadAtOnce)) pipe.reset();
  return take_progress_lines(worker.progress);
}

// Allows no grace period, because the worker might use even more memory.
void LocalExecutor::watch_memory(Worker& worker) {
  if (worker.memory_bytes == 0 || resident_bytes(worker.process) <= worker.memory_bytes) return;
  worker.exceeded_memory = true;
  signal_group(worker.process, SIGKILL);
}

// The system limits the size of one file only. While a worker ends, /proc does not tell what it has
// written to a daemon that is not root.
void LocalExecutor::watch_output(Worker& worker) {
  if (worker.most_written_bytes == 0) return;
  if (written_bytes(worker.process).value_or(0) <= worker.most_written_bytes) return;
  worker.exceeded_output = true;
  signal_group(worker.process, SIGKILL);
}

// Once the worker has ended, kills its children.
Observation LocalExecutor::observe(Worker& worker) {
  read_words(worker);
  std::vector<std::string> progress = read_progress_lines(worker);
  const auto status = wait_for_end(worker.process);
  if (!status) {
    watch_memory(worker);
    watch_output(worker);
    return WorkerRuns{std::move(progress)};
  }
  signal_group(worker.process, SIGKILL);
  read_words(worker);
  return WorkerEnds{*status,
                    std::move(progress),
                    std::move(worker.errors),
                    std::move(worker.answer),
                    worker.exceeded_memory,
                    false,
                    worker.exceeded_output};
}

}  // namespace hydroprint::daemon
