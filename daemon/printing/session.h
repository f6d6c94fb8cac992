#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>

#include "daemon/config/printer_config.h"
#include "daemon/printing/record.h"
#include "daemon/store/job_store.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// One print, from its creation to its end in the store: asks the printer what it is, sends the
/// document once, follows it, tells the store, and keeps the record. go() is one thread's, the rest
/// anybody's.
class PrintSession {
 public:
  /// @param job  just created
  PrintSession(const PrinterConfig& setup, JobStore& jobs, const Layout& layout, const Job& job,
               const PrintPlan& plan);

  [[nodiscard]] std::int64_t job() const { return job_; }

  /// Takes as long as the print, or until shortly after leave().
  void go();
  /// Has the printer end it; while it is being sent, breaks that off.
  void cancel() { cancelled_ = true; }
  /// Has go() return soon; the printer goes on.
  void leave() { left_ = true; }

 private:
  [[nodiscard]] Status print();
  [[nodiscard]] Result<printer::Submitted> send();
  void note(const Warnings& warnings);
  void note(const printer::JobReport& report);
  void tell(std::string_view phase, double fraction, const std::string& message);
  void finish(const Status& done);
  [[nodiscard]] JobState ending(const Status& done) const;
  [[nodiscard]] std::vector<Artifact> publish_record();

  const PrinterConfig setup_;
  JobStore& jobs_;
  const Layout layout_;
  const std::int64_t job_;
  const std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  PrintFacts facts_;
  std::atomic<bool> cancelled_ = false, left_ = false;
};

}  // namespace hydroprint::daemon
