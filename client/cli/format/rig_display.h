#pragma once

#include <chrono>
#include <string>

#include "client/cli/terminal/console.h"
#include "client/rig.h"

namespace hydroprint::cli {

/// The rig in one line: state, position, speed, who has the lease, what is wrong and what to do.
[[nodiscard]] std::string rig_line(const client::Rig& rig);

/// The rig in some lines, with what it may do and how well its drive answers.
[[nodiscard]] std::string rig_lines(const client::Rig& rig);

/// "alice has the lease for 'calibration' until 2026-03-01 14:05:09", or "nobody has the lease".
[[nodiscard]] std::string lease_line(const client::Lease* lease);

/// Shows the rig as it changes: one live line on a terminal; otherwise a line for whatever changes,
/// but for a position that changes, at most one a second.
class RigDisplay {
 public:
  /// @param descriptor  where to show it: STDOUT_FILENO or STDERR_FILENO
  explicit RigDisplay(int descriptor) : line_(descriptor) {}

  void update(const client::Rig& rig);
  /// One line that stays, whatever is shown.
  void say(const std::string& text) { line_.say(text); }

 private:
  LiveLine line_;
  std::string last_key_, last_line_;
  std::chrono::steady_clock::time_point last_time_;
};

}  // namespace hydroprint::cli
