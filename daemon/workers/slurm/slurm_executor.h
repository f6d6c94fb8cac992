#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "daemon/workers/slurm/folder_lock.h"
#include "daemon/workers/slurm/queue_query.h"
#include "daemon/workers/slurm/run_files.h"
#include "daemon/workers/slurm/settings.h"
#include "daemon/workers/worker_executor.h"

namespace hydroprint::daemon::slurm {

/// SlurmExecutor::name()
inline constexpr const char* kSlurmExecutor = "slurm";

/// Hands workers over to Slurm. What their scripts leave in the folders of the executions is the
/// truth, and Slurm's word a hint: a worker has ended when there is an exit file, and is gone only
/// if Slurm knows nothing of a job that waits or runs, and no exit file appears within 60 s.
/// Only one call at a time waits for Slurm, for a second at most; after a call without answer, none
/// is made for five.
class SlurmExecutor final : public WorkerExecutor {
 public:
  /// Times that tests shorten.
  struct Pace {
    std::chrono::milliseconds between_queries{1000};
    std::chrono::milliseconds query_patience{10'000};
    std::chrono::milliseconds exit_file{60'000};     ///< how long to wait for it
    std::chrono::milliseconds submit_again{15'000};  ///< least time between submissions of a job
    std::chrono::milliseconds pause{5'000};          ///< after a call without answer
  };

  /// Creates the folder of the installation, if it is missing, and locks it.
  /// @return kFailedPrecondition if the shared folder does not exist, the programs of Slurm are
  ///         missing, or the installation's folder is not the daemon's alone (see
  ///         check_installation_folder()) or another daemon's; errors of the folder
  [[nodiscard]] static Result<std::unique_ptr<SlurmExecutor>> make(Settings settings, Pace pace);

  [[nodiscard]] std::string name() const override { return kSlurmExecutor; }
  [[nodiscard]] bool outlives_daemon() const override { return true; }
  [[nodiscard]] int capacity() const override { return settings_.jobs; }
  [[nodiscard]] std::filesystem::path runs(const Layout&) const override {
    return installation_folder(settings_);
  }
  /// Errors: the shared folder is missing or full, or another daemon has taken it over.
  [[nodiscard]] Status ready() override;
  /// The handle is Slurm's id, or empty. Errors: those of submit().
  [[nodiscard]] Result<std::string> start(const Execution& execution,
                                          const Launch& launch) override;
  [[nodiscard]] Observations poll(const std::vector<Execution>& executions) override;
  [[nodiscard]] Status cancel(const Execution& execution, CancelHow how) override;
  [[nodiscard]] Adoption adopt(const Execution& execution) override;
  /// Also ends jobs of the installation that Slurm still has, once it answers.
  void keep_only(const std::vector<Execution>& executions) override;
  [[nodiscard]] std::vector<int> descriptors() const override { return query_.descriptors(); }

 private:
  using Time = std::chrono::steady_clock::time_point;

  /// What the executor remembers of one execution. The rest is in its files.
  struct Watch {
    ProgressReader progress;
    Time used;                         // answers that were asked for until then are not news
    Time submitted;                    // last call of sbatch
    int accepted_blindly = 0;          // calls of sbatch that succeeded without an id
    bool is_unanswered = false;        // Slurm may not have the job
    bool is_cancelled = false;         // scancel was called
    std::optional<Time> absent_since;  // Slurm knows no job that waits or runs
    std::optional<Time> exit_seen;
  };

  SlurmExecutor(Settings settings, Pace pace, FolderLock lock, bool is_new_folder);
  void beat();
  [[nodiscard]] bool is_paused() const { return std::chrono::steady_clock::now() < paused_until_; }
  void pause() { paused_until_ = std::chrono::steady_clock::now() + pace_.pause; }
  void end_unknown();
  [[nodiscard]] const QueueEntry* word_on(const Execution& execution) const;
  [[nodiscard]] std::optional<Observation> observe(const Execution& execution, Watch& watch);
  [[nodiscard]] std::optional<Observation> observe_end(const Execution& execution, Watch& watch,
                                                       int status);
  [[nodiscard]] std::optional<Observation> judge_word(const Execution& execution, Watch& watch,
                                                      const QueueEntry* word);
  [[nodiscard]] std::optional<Observation> submit_again(const Execution& execution, Watch& watch);
  [[nodiscard]] Result<std::string> hand_over(const Execution& execution, Watch& watch,
                                              std::string& words);
  [[nodiscard]] bool is_absent_for_long(std::optional<Time>& since) const;

  Settings settings_;
  Pace pace_;
  FolderLock lock_;
  bool is_new_folder_;  // nothing is known of earlier executions
  Status locked_;       // the result of the last heartbeat
  Time next_beat_, paused_until_;
  QueueQuery query_;
  std::map<std::int64_t, Watch> watches_;             // by job
  std::set<std::int64_t> offered_;                    // jobs that are offered for adoption
  std::optional<std::set<std::string>> known_names_;  // until unknown jobs are ended
};

}  // namespace hydroprint::daemon::slurm
