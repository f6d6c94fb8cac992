#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>

#include "daemon/config/printer_config.h"
#include "daemon/printing/record.h"
#include "daemon/store/device_jobs.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// One print, from its creation to its end in the store. Reads the printer's attributes, sends the
/// document once, follows the print, updates the store and keeps the record. One thread calls go();
/// the other functions are thread-safe.
class PrintSession {
 public:
  /// @param job  the job, just created
  PrintSession(const PrinterConfig& setup, DeviceJobs& jobs, const Layout& layout, const Job& job,
               const PrintPlan& plan);

  [[nodiscard]] std::int64_t job() const { return job_; }

  /// Runs until the print ends, or until shortly after leave().
  void go();
  /// Cancels the print on the printer. If the document is still being sent, aborts the transfer.
  void cancel() { cancelled_ = true; }
  /// Makes go() return soon; the printer continues the print.
  void leave() { left_ = true; }

 private:
  [[nodiscard]] Status print();
  [[nodiscard]] Result<printer::Submitted> send();
  void note(const Warnings& warnings);
  void note(const printer::JobReport& report);
  void publish(std::string_view phase, double fraction, const std::string& message);
  void finish(const Status& done);
  [[nodiscard]] JobState ending(const Status& done) const;
  [[nodiscard]] std::vector<Artifact> publish_record();

  const PrinterConfig setup_;
  DeviceJobs& jobs_;
  const Layout layout_;
  const std::int64_t job_;
  const std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  PrintFacts facts_;
  std::atomic<bool> cancelled_ = false, left_ = false;
};

}  // namespace hydroprint::daemon
