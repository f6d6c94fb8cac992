#pragma once

#include <memory>
#include <string>

#include "sim/base/result.h"
#include "sim/worker/common/task.h"

namespace hydroprint::worker {

/// The parsed command line.
struct CommandLine {
  enum class Action { kRun, kPrint, kRefuse };
  Action action = Action::kRun;
  RunOptions run;
  std::unique_ptr<Task> task;  ///< kRun
  bool uses_flags = true;      ///< false: the options came from `--spec`
  std::string text;            ///< kPrint: help or version
  Error error;                 ///< kRefuse
  ExitStatus status = ExitStatus::kDone;
};

/// Reads the command line and the spec or pose file that it names. Checks all options as far as
/// possible without reading the other input files. Refuses an invalid command line with kUsage,
/// and an invalid spec or values out of range with kBadInput.
[[nodiscard]] CommandLine parse_command_line(int argc, const char* const* argv);

}  // namespace hydroprint::worker
