#pragma once

#include <memory>
#include <string>

#include "sim/base/result.h"
#include "sim/worker/common/task.h"

namespace hydroprint::worker {

/// What a command line asks for.
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

/// Reads the command line and the spec or pose file that it names; checks all options as far as
/// possible without the other files. Refuses with kUsage a command line that is not valid, with
/// kBadInput values out of range and a spec that is not valid.
[[nodiscard]] CommandLine parse_command_line(int argc, const char* const* argv);

}  // namespace hydroprint::worker
