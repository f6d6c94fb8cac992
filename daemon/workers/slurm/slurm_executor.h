#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/workers/command_run.h"
#include "daemon/workers/slurm/folder_lock.h"
#include "daemon/workers/slurm/queue.h"
#include "daemon/workers/slurm/run_files.h"
#include "daemon/workers/slurm/settings.h"
#include "daemon/workers/worker_executor.h"

namespace hydroprint::daemon::slurm {

/// SlurmExecutor::name()
inline constexpr const char* kSlurmExecutor = "slurm";

/// Hands workers over to Slurm. What their scripts leave in the folders of the executions is the
/// truth, and Slurm's word a hint: a worker has ended when there is an exit file, and is gone only
/// if Slurm knows nothing of a job that waits or runs, and no exit file appears within 60 s.
/// One query for all jobs runs at most once a second, beside the caller.
class SlurmExecutor final : public WorkerExecutor {
 public:
  /// Times that tests shorten.
  struct Pace {
    std::chrono::milliseconds between_queries{1000};
    std::chrono::milliseconds query_patience{10'000};
    std::chrono::milliseconds exit_file{60'000};  ///< how long to wait for it
  };

  /// Locks the folder of the installation.
  /// @return kFailedPrecondition if another daemon has it, or the programs of Slurm are missing;
  ///         errors of the folder
  [[nodiscard]] static Result<std::unique_ptr<SlurmExecutor>> make(Settings settings, Pace pace);

  [[nodiscard]] std::string name() const override { return kSlurmExecutor; }
  [[nodiscard]] bool outlives_daemon() const override { return true; }
  [[nodiscard]] int capacity() const override { return settings_.jobs; }
  [[nodiscard]] std::filesystem::path runs(const Layout&) const override {
    return installation_folder(settings_);
  }
  /// The handle is Slurm's id, or empty. Errors: those of submit().
  [[nodiscard]] Result<std::string> start(const Execution& execution,
                                          const Launch& launch) override;
  [[nodiscard]] Observations poll(const std::vector<Execution>& executions) override;
  [[nodiscard]] Status cancel(const Execution& execution, CancelHow how) override;
  [[nodiscard]] Adoption adopt(const Execution& execution) override;
  void keep_only(const std::vector<Execution>& executions) override;
  [[nodiscard]] std::vector<int> descriptors() const override;

 private:
  using Time = std::chrono::steady_clock::time_point;

  /// What is known of one execution beside its files.
  struct Watch {
    ProgressReader progress;
    Time used;                         // answers that were asked for until then are not news
    bool is_unanswered = false;        // Slurm may not have got the job
    bool is_cancelled = false;         // scancel was called
    std::optional<Time> absent_since;  // Slurm knows no job that waits or runs
    std::optional<Time> exit_seen;
  };
  /// The last complete answer of Slurm.
  struct Answer {
    Queue queue;
    Time asked;
  };

  SlurmExecutor(Settings settings, Pace pace, FolderLock lock)
      : settings_(std::move(settings)), pace_(pace), lock_(std::move(lock)) {}
  void beat();
  void ask();
  void take_answer(const CommandEnd& end);
  void wait_for_first_answer();
  [[nodiscard]] bool is_answered_since(Time since) const {
    return answer_ && answer_->asked > since;
  }
  [[nodiscard]] const QueueEntry* word_on(const Execution& execution) const;
  [[nodiscard]] std::optional<Observation> observe(const Execution& execution, Watch& watch);
  [[nodiscard]] std::optional<Observation> observe_end(const Execution& execution, Watch& watch,
                                                       int status);
  [[nodiscard]] std::optional<Observation> observe_absence(const Execution& execution, Watch& watch,
                                                           const QueueEntry* word);
  [[nodiscard]] std::optional<Observation> submit_again(const Execution& execution, Watch& watch);
  [[nodiscard]] bool is_absent_for_long(std::optional<Time>& since) const;

  Settings settings_;
  Pace pace_;
  FolderLock lock_;
  Status locked_;  // the result of the last heartbeat
  Time next_beat_, next_query_, query_began_;
  bool has_waited_ = false;
  bool is_silent_ = false;
  std::optional<CommandRun> query_;
  std::optional<Answer> answer_;
  std::map<std::int64_t, Watch> watches_;               // of started and adopted executions
  std::map<std::int64_t, std::optional<Time>> offers_;  // absent since, of offered executions
};

}  // namespace hydroprint::daemon::slurm
