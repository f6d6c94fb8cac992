#pragma once

#include <chrono>
#include <string>

#include "client/cli/terminal/console.h"
#include "hydroprint/v1/rig.pb.h"

namespace hydroprint::cli {

/// Describes the rig in one line: state, position, speed, lease holder, fault and remedy.
[[nodiscard]] std::string rig_line(const v1::Rig& rig);

/// Describes the rig in several lines, with the axis limits and the quality of the link to the
/// drive.
[[nodiscard]] std::string rig_lines(const v1::Rig& rig);

/// Returns "alice holds the lease for 'calibration' until 2026-03-01 14:05:09", or "nobody holds
/// the lease".
[[nodiscard]] std::string lease_line(const v1::Lease* lease);

/// Shows changes of the rig: a line that is updated in place on a terminal; elsewhere one line for
/// each change. Changes of only the position are shown at most once a second.
class RigDisplay {
 public:
  /// @param descriptor  destination: STDOUT_FILENO or STDERR_FILENO
  explicit RigDisplay(int descriptor) : line_(descriptor) {}

  void update(const v1::Rig& rig);
  /// Prints a permanent line above the live one.
  void say(const std::string& text) { line_.say(text); }

 private:
  LiveLine line_;
  std::string last_key_, last_line_;
  std::chrono::steady_clock::time_point last_time_;
};

}  // namespace hydroprint::cli
