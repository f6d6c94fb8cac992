#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "daemon/workers/worker_executor.h"

namespace hydroprint::daemon {

/// LocalExecutor::name()
inline constexpr const char* kLocalExecutor = "local";

/// Runs workers as processes of this machine, each confined and below its memory limit. They die
/// with the thread that started them, so that none survives a killed daemon, and with the executor.
class LocalExecutor final : public WorkerExecutor {
 public:
  /// @param capacity  see WorkerExecutor::capacity()
  explicit LocalExecutor(int capacity) : capacity_(capacity) {}
  ~LocalExecutor() override;

  [[nodiscard]] std::string name() const override { return kLocalExecutor; }
  [[nodiscard]] bool outlives_daemon() const override { return false; }
  [[nodiscard]] int capacity() const override { return capacity_; }
  /// The handle is the process id. Errors: those of launch().
  [[nodiscard]] Result<std::string> start(const Execution& execution,
                                          const Launch& launch) override;
  [[nodiscard]] Observations poll(const std::vector<Execution>& executions) override;
  [[nodiscard]] Status cancel(const Execution& execution, CancelHow how) override;
  [[nodiscard]] Adoption adopt(const Execution& execution) override;
  [[nodiscard]] std::vector<int> descriptors() const override;

 private:
  struct Worker {
    ChildProcess process;
    std::int64_t memory_bytes = 0;        // limit; 0: none
    std::int64_t most_written_bytes = 0;  ///< 0: unlimited
    bool exceeded_memory = false, exceeded_output = false;
    std::string errors, answer;  // last bytes of its stderr and stdout
    std::string progress;        // received bytes of an incomplete line
  };

  static void read_words(Worker& worker);
  static std::vector<std::string> read_progress_lines(Worker& worker);
  static void watch_memory(Worker& worker);
  static void watch_output(Worker& worker);
  static Observation observe(Worker& worker);

  int capacity_;
  std::map<std::int64_t, Worker> workers_;  // by job
};

}  // namespace hydroprint::daemon
