#pragma once

#include <optional>
#include <string>

#include "client/cli/console.h"
#include "client/jobs.h"

namespace hydroprint::cli {

/// Shows how a job goes: a bar with the time left on a terminal, otherwise a line whenever its
/// state or stage changes or another tenth is done.
class JobDisplay {
 public:
  /// @param descriptor  where to show it: STDOUT_FILENO or STDERR_FILENO
  JobDisplay(std::string job, int descriptor);

  void update(const client::JobUpdate& update);
  /// One line that stays, whatever is shown.
  void say(const std::string& text);

 private:
  void show();
  [[nodiscard]] std::string text() const;

  std::string job_;
  int descriptor_;
  ProgressLine line_;
  client::JobState state_ = client::JobState::kUnknown;
  double progress_fraction_ = 0;
  std::string phase_;
  std::optional<client::Time> eta_time_;
  std::string last_key_;
};

}  // namespace hydroprint::cli
