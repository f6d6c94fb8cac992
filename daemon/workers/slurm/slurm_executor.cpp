#include "daemon/workers/slurm/slurm_executor.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>

#include "daemon/platform/log.h"
#include "daemon/workers/slurm/submission.h"

namespace hydroprint::daemon::slurm {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::chrono::seconds kPatience{10};
constexpr std::chrono::seconds kBetweenBeats{10};
// How long a job may be COMPLETING before its end is judged without Slurm's final word.
constexpr std::chrono::seconds kFinalWord{60};
constexpr std::int64_t kLeastFree = 64 << 20;  // of the shared folder
constexpr int kMostBlindly = 5;
constexpr int kUnusable = 127 << 8;  // the status of a worker that cannot be started

void set_limit(WorkerEnds& end, const QueueEntry& word) {
  end.exceeded_time =
      word.state == "TIMEOUT" || word.state == "DEADLINE" || word.reason == "TimeLimit";
  end.exceeded_memory = word.state == "OUT_OF_MEMORY";
}

bool is_ended(const QueueEntry* word) { return word == nullptr || word->phase == Phase::kEnded; }

// Returns whether Slurm ended the worker for reasons of its own, so that it has to run again.
bool was_taken_back(const QueueEntry* word) {
  return word == nullptr || word->state == "NODE_FAIL" || word->state == "BOOT_FAIL" ||
         word->state == "PREEMPTED" || word->state == "REVOKED";
}

// Returns whether somebody ended the worker, and only Slurm can say why.
bool is_ended_from_outside(int status) {
  constexpr int kInterrupted = 130;
  if (WIFEXITED(status)) return WEXITSTATUS(status) == kInterrupted;
  return WTERMSIG(status) == SIGTERM || WTERMSIG(status) == SIGKILL;
}

Status check_program(const char* program, const std::filesystem::path& folder) {
  HP_ASSIGN_OR_RETURN(const CommandEnd end, run_command({program, "--version"}, folder, kPatience));
  if (end.status == 0) return {};
  return fail(Code::kFailedPrecondition,
              fmt::format("{} --version failed{}{}; run hydroprint admin check", program,
                          end.errors.empty() ? "" : ": ", end.errors),
              ErrorReason::WORKER_UNUSABLE);
}

}  // namespace

Result<std::unique_ptr<SlurmExecutor>> SlurmExecutor::make(Settings settings, Pace pace) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(settings.folder, ignored)) {
    return fail(Code::kFailedPrecondition,
                settings.folder.string() +
                    " (workers.slurm.folder) does not exist; create it, or mount the shared file "
                    "system");
  }
  for (const char* program : {"sbatch", "squeue", "scancel"}) {
    HP_RETURN_IF_ERROR(check_program(program, settings.folder));
  }
  const auto folder = installation_folder(settings);
  const bool is_new = ::mkdir(folder.c_str(), 0700) == 0;
  if (!is_new && errno != EEXIST) return system_failure(folder, "the folder cannot be created");
  HP_RETURN_IF_ERROR(check_installation_folder(settings));
  HP_ASSIGN_OR_RETURN(FolderLock lock, FolderLock::take(folder));
  return std::unique_ptr<SlurmExecutor>(
      new SlurmExecutor(std::move(settings), pace, std::move(lock), is_new));
}

SlurmExecutor::SlurmExecutor(Settings settings, Pace pace, FolderLock lock, bool is_new_folder)
    : settings_(std::move(settings)),
      pace_(pace),
      lock_(std::move(lock)),
      is_new_folder_(is_new_folder),
      query_(installation_folder(settings_), pace.between_queries, pace.query_patience) {}

Status SlurmExecutor::ready() {
  std::error_code ignored;
  if (!std::filesystem::is_directory(installation_folder(settings_), ignored)) {
    return fail(Code::kFailedPrecondition,
                installation_folder(settings_).string() +
                    " (workers.slurm.folder) is missing; mount the shared file system");
  }
  HP_RETURN_IF_ERROR(locked_);
  return check_free_space(installation_folder(settings_), kLeastFree);
}

Result<std::string> SlurmExecutor::start(const Execution& execution, const Launch& launch) {
  HP_RETURN_IF_ERROR(write_script(settings_, execution, launch));
  Watch watch;
  std::string words;
  if (known_names_) known_names_->insert(job_name(execution.folder));
  HP_ASSIGN_OR_RETURN(std::string id, hand_over(execution, watch, words));
  watches_.insert_or_assign(execution.job, std::move(watch));
  return id;
}

Observations SlurmExecutor::poll(const std::vector<Execution>& executions) {
  beat();
  std::set<std::int64_t> jobs = offered_;
  for (const Execution& execution : executions) jobs.insert(execution.job);
  std::erase_if(watches_, [&](const auto& entry) { return !jobs.contains(entry.first); });
  query_.step(!jobs.empty() || known_names_);
  end_unknown();
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
  if (is_paused()) return fail(Code::kUnavailable, "Slurm does not answer");
  const Status ended = end_job(job_name(execution.folder), installation_folder(settings_));
  if (!ended) pause();
  return ended;
}

Adoption SlurmExecutor::adopt(const Execution& execution) {
  const RunFolder folder{execution.folder};
  offered_.insert(execution.job);
  query_.wait_once();
  query_.step(true);
  Watch& watch = watches_[execution.job];
  const bool is_news = query_.is_answered_since(watch.used);
  const QueueEntry* const word = is_news ? word_on(execution) : nullptr;
  if (is_news) watch.used = SteadyClock::now();
  std::error_code ignored;
  const bool has_script = std::filesystem::exists(script_file(folder), ignored);
  const bool is_mounted = std::filesystem::exists(folder.root.parent_path(), ignored);
  Adoption out = Adoption::kNoAnswer;
  if (wait_status(folder) || has_begun(folder) || !is_ended(word)) {
    out = Adoption::kAdopted;
  } else if (is_new_folder_ || !is_mounted) {
    return Adoption::kNoAnswer;  // the shared file system may not be mounted
  } else if (!has_script && execution.handle.empty()) {
    out = Adoption::kGone;  // it was not handed over
  } else if (word != nullptr || (is_news && is_absent_for_long(watch.absent_since))) {
    out = Adoption::kGone;
  }
  if (out != Adoption::kNoAnswer) offered_.erase(execution.job);
  if (out == Adoption::kAdopted) watch.used = {};  // poll() judges the same answer
  return out;
}

void SlurmExecutor::keep_only(const std::vector<Execution>& executions) {
  known_names_.emplace();
  for (const Execution& execution : executions) {
    known_names_->insert(job_name(execution.folder));
  }
  std::error_code error;
  for (const auto& entry :
       std::filesystem::directory_iterator(installation_folder(settings_), error)) {
    if (!entry.is_directory(error) || known_names_->contains(job_name(entry.path()))) continue;
    discard(entry.path());
  }
}

// Ends jobs that Slurm kept from executions which this daemon does not know, as after a restore.
void SlurmExecutor::end_unknown() {
  if (!known_names_ || !query_.answer() || is_paused()) return;
  const std::string own = job_name(installation_folder(settings_) / "");
  for (const auto& [name, word] : query_.answer()->queue) {
    if (!name.starts_with(own) || is_ended(&word) || known_names_->contains(name)) continue;
    log(LogLevel::kWarning, "cluster_job_unknown", {{"name", name}});
    if (!end_job(name, installation_folder(settings_))) return pause();
  }
  known_names_.reset();
}

void SlurmExecutor::beat() {
  const auto now = SteadyClock::now();
  if (now < next_beat_) return;
  next_beat_ = now + kBetweenBeats;
  locked_ = lock_.beat();
}

// Returns Slurm's word of the last answer; nullptr if it knows no job of the execution.
const QueueEntry* SlurmExecutor::word_on(const Execution& execution) const {
  const Queue& queue = query_.answer()->queue;
  const auto found = queue.find(job_name(execution.folder));
  return found == queue.end() ? nullptr : &found->second;
}

std::optional<Observation> SlurmExecutor::observe(const Execution& execution, Watch& watch) {
  const RunFolder folder{execution.folder};
  if (const auto status = wait_status(folder)) return observe_end(execution, watch, *status);
  auto progress = watch.progress.lines(folder);
  std::optional<Observation> out;
  if (query_.is_answered_since(watch.used)) {
    const QueueEntry* const word = word_on(execution);
    watch.used = SteadyClock::now();
    // A node that has lost its slurmd may go on with the worker.
    if (!progress.empty() && word != nullptr && word->state == "NODE_FAIL") {
      watch.absent_since.reset();
    } else {
      out = judge_word(execution, watch, word);
    }
  }
  const bool is_over = out && (std::holds_alternative<WorkerEnds>(*out) ||
                               std::holds_alternative<WorkerIsGone>(*out));
  if (!is_over && !progress.empty()) return WorkerRuns{std::move(progress)};
  return out;
}

// There is an exit file. If the worker was ended from outside, Slurm may have done it.
std::optional<Observation> SlurmExecutor::observe_end(const Execution& execution, Watch& watch,
                                                      int status) {
  const RunFolder folder{execution.folder};
  WorkerEnds end{status, {}, errors_of(folder), answer_of(folder)};
  if (is_ended_from_outside(status) && !watch.is_cancelled) {
    const auto now = SteadyClock::now();
    if (!watch.exit_seen) watch.exit_seen = now;
    if (!query_.is_answered_since(*watch.exit_seen)) return std::nullopt;
    const QueueEntry* const word = word_on(execution);
    if (!is_ended(word) && now - *watch.exit_seen < kFinalWord) return std::nullopt;
    if (was_taken_back(word)) return WorkerIsGone();
    set_limit(end, *word);
  }
  end.progress = watch.progress.lines(folder);
  return end;
}

// Judges a new answer of Slurm about a worker that has left no exit file.
std::optional<Observation> SlurmExecutor::judge_word(const Execution& execution, Watch& watch,
                                                     const QueueEntry* word) {
  const bool begun = has_begun({execution.folder});
  if (!is_ended(word)) {
    watch.absent_since.reset();
    watch.is_unanswered = false;
    if (word->phase == Phase::kWaits) return WorkerWaits{word->reason};
    return begun ? std::optional<Observation>(WorkerRuns()) : WorkerWaits{"starting"};
  }
  if (word != nullptr) {
    WorkerEnds end{.wait_status = SIGKILL};
    set_limit(end, *word);
    if (end.exceeded_time || end.exceeded_memory) return end;
  }
  if (watch.is_cancelled && (word != nullptr || !begun)) return WorkerIsGone();
  if (watch.is_unanswered && word == nullptr && !begun) return submit_again(execution, watch);
  if (is_absent_for_long(watch.absent_since)) return WorkerIsGone();
  return std::nullopt;
}

// Slurm did not take the job, or did not say so, and does not know it now. If it gets the job
// twice, the second script ends at once.
std::optional<Observation> SlurmExecutor::submit_again(const Execution& execution, Watch& watch) {
  if (SteadyClock::now() - watch.submitted < pace_.submit_again) return std::nullopt;
  std::string words;
  auto id = hand_over(execution, watch, words);
  if (id && watch.accepted_blindly >= kMostBlindly) {
    id = fail(Code::kInternal, "sbatch succeeds, but squeue does not show the job",
              ErrorReason::WORKER_UNUSABLE);
  }
  if (!id) return WorkerEnds{.wait_status = kUnusable, .errors = id.error().message};
  if (words.empty()) return std::nullopt;
  return WorkerWaits{words};
}

// Calls sbatch, unless Slurm is silent. Returns the id, or nothing if it is unknown whether Slurm
// has the job; then `words` may say why.
Result<std::string> SlurmExecutor::hand_over(const Execution& execution, Watch& watch,
                                             std::string& words) {
  watch.is_unanswered = true;
  watch.used = watch.submitted = SteadyClock::now();
  if (is_paused()) return std::string();
  HP_ASSIGN_OR_RETURN(Submitted submitted, submit(execution));
  watch.used = SteadyClock::now();
  if (submitted.is_silent) pause();
  words = std::move(submitted.words);
  watch.is_unanswered = submitted.id.empty();
  if (submitted.id.empty() && words.empty() && !submitted.is_silent) ++watch.accepted_blindly;
  return std::move(submitted.id);
}

bool SlurmExecutor::is_absent_for_long(std::optional<Time>& since) const {
  const auto now = SteadyClock::now();
  if (!since) since = now;
  return now - *since >= pace_.exit_file;
}

}  // namespace hydroprint::daemon::slurm
