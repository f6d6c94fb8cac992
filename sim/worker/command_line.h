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
  std::unique_ptr<Task> task;            ///< for kRun
  std::optional<std::string> spec_file;  ///< nullopt: the options came from flags
  std::string text;                      ///< for kPrint: help or version
  Error error;                           ///< for kRefuse
  ExitStatus status = ExitStatus::kDone;
};

/// Parses the command line and the spec or pose file that it names. Checks the options as far as
/// possible without reading other input files. Returns a refusal with kUsage for an invalid command
/// line, and with kBadInput for an invalid spec or values out of range.
[[nodiscard]] CommandLine parse_command_line(int argc, const char* const* argv);

}  // namespace hydroprint::worker
