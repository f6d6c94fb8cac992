#pragma once

#include "client/cli/program/program.h"
#include "hydroprint/v1/rig.pb.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// Returns an error with the remedy if the drive has acknowledged a stop and does not slow down
/// (Rig.cause is STOP_NOT_OBEYED).
[[nodiscard]] Status stop_obeyed(const v1::Rig& rig);

/// Tells a person at the terminal at once that a stop is not obeyed.
class StopAlarm {
 public:
  /// When the rig begins to report STOP_NOT_OBEYED: prints one line on standard error, and rings
  /// the bell if that is a terminal.
  void look(const v1::Rig& rig);
  /// Asks the daemon for the rig first. Errors are ignored.
  void look(const Program& program);

 private:
  bool is_on_ = false;
};

}  // namespace hydroprint::cli
