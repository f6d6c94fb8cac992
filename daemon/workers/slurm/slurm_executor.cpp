#include "daemon/workers/slurm/slurm_executor.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>

#include "daemon/platform/log.h"
#include "daemon/workers/slurm/submission.h"

namespace hydroprint::daemon::slurm {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::chrono::seconds kPatience{10};
constexpr std::chrono::seconds kBetweenBeats{10};
constexpr std::chrono::seconds kFirstAnswer{2};
// How long Slurm may take to say why a signal ended a worker.
constexpr std::chrono::seconds kFinalWord{10};
constexpr int kTick_ms = 50;
constexpr int kUnusable = 127 << 8;  // the status of a worker that cannot be started

void set_limit(WorkerEnds& end, const QueueEntry& word) {
  end.exceeded_time = word.state == "TIMEOUT" || word.state == "DEADLINE";
  end.exceeded_memory = word.state == "OUT_OF_MEMORY";
}

// Returns whether Slurm ended the worker for reasons of its own, so that it has to run again.
bool was_taken_back(const QueueEntry* word) {
  return word == nullptr || word->state == "NODE_FAIL" || word->state == "BOOT_FAIL" ||
         word->state == "PREEMPTED" || word->state == "REVOKED";
}

}  // namespace

Result<std::unique_ptr<SlurmExecutor>> SlurmExecutor::make(Settings settings, Pace pace) {
  HP_ASSIGN_OR_RETURN(FolderLock lock, FolderLock::take(installation_folder(settings)));
  std::unique_ptr<SlurmExecutor> out(new SlurmExecutor(std::move(settings), pace, std::move(lock)));
  const auto folder = installation_folder(out->settings_);
  for (const char* program : {"sbatch", "squeue", "scancel"}) {
    HP_ASSIGN_OR_RETURN(const CommandEnd end,
                        run_command({program, "--version"}, folder, kPatience));
    if (end.status != 0) {
      return fail(Code::kFailedPrecondition,
                  fmt::format("{} --version failed{}{}; run hydroprint admin check", program,
                              end.errors.empty() ? "" : ": ", end.errors),
                  "WORKER_UNUSABLE");
    }
  }
  return out;
}

Result<std::string> SlurmExecutor::start(const Execution& execution, const Launch& launch) {
  HP_RETURN_IF_ERROR(locked_);
  HP_RETURN_IF_ERROR(write_script(settings_, execution, launch));
  Watch watch;
  watch.used = SteadyClock::now();
  HP_ASSIGN_OR_RETURN(const Submitted submitted, submit(execution));
  watch.is_unanswered = submitted.id.empty();
  watches_.insert_or_assign(execution.job, std::move(watch));
  return submitted.id;
}

Observations SlurmExecutor::poll(const std::vector<Execution>& executions) {
  beat();
  std::erase_if(watches_, [&](const auto& entry) {
    return std::none_of(executions.begin(), executions.end(),
                        [&](const Execution& e) { return e.job == entry.first; });
  });
  if (!executions.empty() || !offers_.empty()) ask();
  Observations out;
  for (const Execution& execution : executions) {
    if (auto seen = observe(execution, watches_[execution.job])) {
      out.emplace(execution.job, *std::move(seen));
    }
  }
  return out;
}

Status SlurmExecutor::cancel(const Execution& execution, CancelHow) {
  watches_[execution.job].is_cancelled = true;
  return end_job(settings_, execution);
}

Adoption SlurmExecutor::adopt(const Execution& execution) {
  const RunFolder folder{execution.folder};
  std::error_code ignored;
  if (!std::filesystem::exists(folder.root.parent_path(), ignored)) return Adoption::kNoAnswer;
  wait_for_first_answer();
  ask();
  const QueueEntry* const word = answer_ ? word_on(execution) : nullptr;
  const bool is_known = word != nullptr && word->phase != Phase::kEnded;
  auto& absent_since = offers_[execution.job];
  Adoption out = Adoption::kNoAnswer;
  if (is_known || wait_status(folder) || has_begun(folder)) {
    out = Adoption::kAdopted;
  } else if (!std::filesystem::exists(script_file(folder), ignored) ||
             (answer_ && is_absent_for_long(absent_since))) {
    out = Adoption::kGone;  // without a script, it was not handed over
  }
  if (out != Adoption::kNoAnswer) offers_.erase(execution.job);
  return out;
}

void SlurmExecutor::keep_only(const std::vector<Execution>& executions) {
  std::error_code error;
  for (const auto& entry :
       std::filesystem::directory_iterator(installation_folder(settings_), error)) {
    const bool is_kept = std::any_of(executions.begin(), executions.end(), [&](const Execution& e) {
      return entry.path().filename() == run_name(e.job, e.attempt);
    });
    if (entry.is_directory(error) && !is_kept) discard(entry.path());
  }
}

std::vector<int> SlurmExecutor::descriptors() const {
  return query_ ? query_->descriptors() : std::vector<int>();
}

void SlurmExecutor::beat() {
  const auto now = SteadyClock::now();
  if (now < next_beat_) return;
  next_beat_ = now + kBetweenBeats;
  locked_ = lock_.beat();
  if (!locked_) {
    log(LogLevel::kError, "cluster_folder_lost", {{"message", locked_.error().message}});
  }
}

// Starts a query, or takes the answer of the one that runs.
void SlurmExecutor::ask() {
  const auto now = SteadyClock::now();
  if (query_) {
    const auto end = query_->poll();
    if (end) {
      query_.reset();
      take_answer(*end);
    }
    return;
  }
  if (now < next_query_) return;
  next_query_ = now + pace_.between_queries;
  query_began_ = now;
  auto query =
      CommandRun::start(queue_command(), installation_folder(settings_), pace_.query_patience);
  if (query) {
    query_.emplace(*std::move(query));
  } else {
    take_answer({-1, {}, query.error().message});
  }
}

void SlurmExecutor::take_answer(const CommandEnd& end) {
  auto queue = end.status == 0 ? parse_queue(end.output, settings_.installation) : std::nullopt;
  if (queue.has_value() == is_silent_) {
    is_silent_ = !queue.has_value();
    log(is_silent_ ? LogLevel::kWarning : LogLevel::kInfo,
        is_silent_ ? "cluster_silent" : "cluster_answers", {{"message", end.errors}});
  }
  if (queue) answer_ = Answer{*std::move(queue), query_began_};
}

// Waits once, so that a daemon that starts knows what runs; later answers are taken as they come.
void SlurmExecutor::wait_for_first_answer() {
  if (has_waited_) return;
  has_waited_ = true;
  const auto deadline = SteadyClock::now() + kFirstAnswer;
  while (!answer_ && SteadyClock::now() < deadline) {
    ask();
    std::vector<pollfd> fds;
    for (const int fd : descriptors()) fds.push_back({fd, POLLIN, 0});
    ::poll(fds.data(), fds.size(), kTick_ms);
  }
}

// Returns Slurm's word of the last answer; nullptr if it knows no job of the execution.
const QueueEntry* SlurmExecutor::word_on(const Execution& execution) const {
  const auto found =
      answer_->queue.find(job_name(settings_.installation, execution.job, execution.attempt));
  return found == answer_->queue.end() ? nullptr : &found->second;
}

std::optional<Observation> SlurmExecutor::observe(const Execution& execution, Watch& watch) {
  const RunFolder folder{execution.folder};
  if (const auto status = wait_status(folder)) return observe_end(execution, watch, *status);
  auto progress = watch.progress.lines(folder);
  if (!progress.empty()) {
    watch.absent_since.reset();  // whatever Slurm says, as when a node has lost its slurmd
    return WorkerRuns{std::move(progress)};
  }
  if (!is_answered_since(watch.used)) return std::nullopt;
  watch.used = SteadyClock::now();
  const QueueEntry* const word = word_on(execution);
  if (word == nullptr || word->phase == Phase::kEnded) {
    return observe_absence(execution, watch, word);
  }
  watch.absent_since.reset();
  watch.is_unanswered = false;
  if (word->phase == Phase::kWaits) return WorkerWaits{word->reason};
  return has_begun(folder) ? std::optional<Observation>(WorkerRuns()) : WorkerWaits{"starting"};
}

// There is an exit file. If a signal ended the worker, Slurm may have sent it because of a limit.
std::optional<Observation> SlurmExecutor::observe_end(const Execution& execution, Watch& watch,
                                                      int status) {
  constexpr int kInterrupted = 130;
  const auto now = SteadyClock::now();
  const bool is_own = WIFEXITED(status) && WEXITSTATUS(status) != kInterrupted;
  const QueueEntry* word = nullptr;
  const bool word_is_needed = !is_own && !watch.is_cancelled;
  if (word_is_needed) {
    if (!watch.exit_seen) watch.exit_seen = now;
    const bool is_late = now - *watch.exit_seen > kFinalWord;
    if (is_answered_since(*watch.exit_seen)) word = word_on(execution);
    const bool is_final =
        is_answered_since(*watch.exit_seen) && (word == nullptr || word->phase == Phase::kEnded);
    if (!is_final && !is_late) return std::nullopt;
  }
  if (word_is_needed && was_taken_back(word)) return WorkerIsGone();
  const RunFolder folder{execution.folder};
  WorkerEnds end{status, watch.progress.lines(folder), errors_of(folder), answer_of(folder)};
  if (word != nullptr) set_limit(end, *word);
  return end;
}

// Slurm knows no job of the execution that waits or runs, and there is no exit file.
std::optional<Observation> SlurmExecutor::observe_absence(const Execution& execution, Watch& watch,
                                                          const QueueEntry* word) {
  if (word != nullptr) {
    WorkerEnds end{.wait_status = SIGKILL};
    set_limit(end, *word);
    if (end.exceeded_time || end.exceeded_memory) return end;
  }
  const bool begun = has_begun({execution.folder});
  if (watch.is_cancelled && (word != nullptr || !begun)) return WorkerIsGone();
  if (watch.is_unanswered && word == nullptr && !begun) return submit_again(execution, watch);
  if (is_absent_for_long(watch.absent_since)) return WorkerIsGone();
  return std::nullopt;
}

// Slurm did not answer sbatch, and does not know the job now. If it gets the job twice, the second
// script ends at once.
std::optional<Observation> SlurmExecutor::submit_again(const Execution& execution, Watch& watch) {
  watch.used = SteadyClock::now();
  const auto submitted = submit(execution);
  if (!submitted) return WorkerEnds{.wait_status = kUnusable, .errors = submitted.error().message};
  watch.is_unanswered = submitted->id.empty();
  return WorkerWaits{"Slurm"};
}

bool SlurmExecutor::is_absent_for_long(std::optional<Time>& since) const {
  const auto now = SteadyClock::now();
  if (!since) since = now;
  return now - *since >= pace_.exit_file;
}

}  // namespace hydroprint::daemon::slurm
