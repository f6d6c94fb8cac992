#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "daemon/print_run.h"

namespace hydroprint::daemon {

/// Carries out prints, one at a time, each in a thread of its own. Any thread may call.
class PrintRunner {
 public:
  /// @param setup  none: no printer is configured
  PrintRunner(std::optional<PrinterSetup> setup, JobStore& jobs, const Layout& layout);
  /// Stops if stop() was not called.
  ~PrintRunner();
  PrintRunner(const PrintRunner&) = delete;
  PrintRunner& operator=(const PrintRunner&) = delete;

  /// kFailedPrecondition, PRINTER_MISSING if no printer is configured.
  [[nodiscard]] Status check() const;
  /// Stores a print and begins it. Refuses what check() and JobStore::create() refuse.
  [[nodiscard]] Result<Job> create(const NewJob& made, const RequestKey& request,
                                   const PrintPlan& plan);
  /// Asks for its end, which comes when the printer says so.
  [[nodiscard]] Result<Job> cancel(std::int64_t job);
  /// The one that is under way; 0: none.
  [[nodiscard]] std::int64_t job() const;

  /// Leaves a print that is under way to the printer, and its job to JobStore::interrupt_all(); a
  /// few seconds at most.
  void stop();

 private:
  const std::optional<PrinterSetup> setup_;
  JobStore& jobs_;
  const Layout layout_;
  mutable std::mutex mutex_;
  bool end_ = false;
  std::unique_ptr<PrintRun> run_;
  std::thread thread_;
};

}  // namespace hydroprint::daemon
