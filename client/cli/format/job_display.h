#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client/cli/terminal/console.h"
#include "client/jobs.h"

namespace hydroprint::cli {

/// What the daemon says beside the job as it stands; empty if nothing, or only what stands in its
/// dip_status as well.
[[nodiscard]] std::string message_of(const client::JobUpdate& update);

/// Warnings of a dip that were not there before.
[[nodiscard]] std::vector<std::string> new_warnings(const std::optional<client::DipStatus>& before,
                                                    const client::DipStatus& now);

/// Shows how a job goes: a bar with the time left on a terminal, otherwise a line whenever its
/// state or stage changes or another tenth is done. Of a dip: its step with what to do, its clock,
/// and warnings as they come.
class JobDisplay {
 public:
  /// @param descriptor  where to show it: STDOUT_FILENO or STDERR_FILENO
  JobDisplay(std::string job, int descriptor);

  void update(const client::JobUpdate& update);
  /// One line that stays, whatever is shown.
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
