#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "daemon/jobs/executor.h"
#include "daemon/printing/session.h"
#include "daemon/store/job_store.h"

namespace hydroprint::daemon {

/// Executes prints, one at a time, each in its own thread. Thread-safe.
class PrintExecutor final : public JobExecutor {
 public:
  /// @param setup  nullopt: no printer is configured
  PrintExecutor(std::optional<PrinterConfig> setup, JobStore& jobs, DeviceJobs& device_jobs,
                const Layout& layout);
  /// Calls stop() if needed.
  ~PrintExecutor() override;

  /// Returns the errors of print_plan_of(), and kFailedPrecondition, PRINTER_MISSING if no printer
  /// is configured.
  [[nodiscard]] Result<Job> check(const JobRequest& request) override;
  [[nodiscard]] Result<Job> create(const JobRequest& request) override;
  /// Requests cancellation; the job ends when the printer confirms it.
  [[nodiscard]] Result<Job> cancel(std::int64_t job) override;
  /// Stops following a running print, which the printer continues; JobStore::interrupt_all() ends
  /// its job. Takes a few seconds at most.
  void stop() override;

 private:
  [[nodiscard]] Status check_printer() const;

  const std::optional<PrinterConfig> setup_;
  JobStore& jobs_;
  DeviceJobs& device_jobs_;
  const Layout layout_;
  std::mutex mutex_;
  bool end_ = false;
  std::unique_ptr<PrintSession> run_;
  std::thread thread_;
};

}  // namespace hydroprint::daemon
