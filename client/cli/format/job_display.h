#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/cli/terminal/console.h"
#include "client/time.h"
#include "hydroprint/v1/job_service.pb.h"

namespace hydroprint::cli {

/// Returns the message of an update; empty if there is none, or if dip_status already contains it.
[[nodiscard]] std::string message_of(const v1::WatchJobResponse& update);

/// Returns the phase of a job, or what it waits for.
[[nodiscard]] std::string phase_text(const std::string& phase, const std::string& waits_for);

/// Returns the warnings of `now` that are not in `before`.
[[nodiscard]] std::vector<std::string> new_warnings(const v1::DipStatus& before,
                                                    const v1::DipStatus& now);

/// Shows the progress of a job. On a terminal, a bar with the time left; elsewhere, a line for each
/// new state or stage and for every further 10 %. For a dip: the step with its instruction and
/// timer, and new warnings.
class JobDisplay {
 public:
  /// @param descriptor  destination: STDOUT_FILENO or STDERR_FILENO
  JobDisplay(std::string job, int descriptor);

  void update(const v1::WatchJobResponse& update);
  /// Prints a permanent line above the progress.
  void say(const std::string& text) { line_.say(text); }

 private:
  void take_dip(const v1::DipStatus& status);
  void show();
  [[nodiscard]] std::string text() const;

  std::string job_;
  ProgressLine line_;
  v1::Job::State state_ = v1::Job::STATE_UNSPECIFIED;
  double progress_fraction_ = 0;
  std::string phase_;
  std::optional<client::Time> eta_time_;
  std::string last_key_;
  std::optional<v1::DipStatus> dip_;
};

}  // namespace hydroprint::cli
