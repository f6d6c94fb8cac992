#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/cli/terminal/console.h"
#include "client/jobs.h"

namespace hydroprint::cli {

/// Returns the message of an update; empty if there is none, or if dip_status already contains it.
[[nodiscard]] std::string message_of(const client::JobUpdate& update);

/// Returns the warnings of a dip that were not in `before`.
[[nodiscard]] std::vector<std::string> new_warnings(const std::optional<client::DipStatus>& before,
                                                    const client::DipStatus& now);

/// Shows the progress of a job. On a terminal, a bar with the time left; elsewhere, a line for each
/// new state or stage and for every further 10 %. For a dip: the step with its instruction and
/// timer, and new warnings.
class JobDisplay {
 public:
  /// @param descriptor  destination: STDOUT_FILENO or STDERR_FILENO
  JobDisplay(std::string job, int descriptor);

  void update(const client::JobUpdate& update);
  /// Prints a line that stays on the screen.
  void say(const std::string& text) { line_.say(text); }

 private:
  void take_dip(const client::DipStatus& status);
  void show();
  [[nodiscard]] std::string text() const;

  std::string job_;
  ProgressLine line_;
  client::JobState state_ = client::JobState::kUnknown;
  double progress_fraction_ = 0;
  std::string phase_;
  std::optional<client::Time> eta_time_;
  std::string last_key_;
  std::optional<client::DipStatus> dip_;
};

}  // namespace hydroprint::cli
