#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "daemon/store/job.h"

namespace hydroprint::daemon {

/// Why the pool ended a worker itself, if it did.
enum class StoppedFor { kNothing, kCancel, kShutdown, kTime, kMemory };

/// The worker's own last word: the last line with anything in it, made fit for one line of text.
[[nodiscard]] std::string last_line(std::string_view errors);

/// What the end of a worker means for its job; none if it succeeded.
/// @param wait_status  as waitpid() gives it
/// @param errors       what it wrote to stderr
/// @param answer       what it wrote to stdout: may tell a reason of ErrorReason, with --json
[[nodiscard]] std::optional<JobFailure> judge(int wait_status, StoppedFor stopped,
                                              std::string_view errors,
                                              std::string_view answer = {});

/// Reads one line of a worker's progress; none for a line that is none (a worker that read a
/// hostile file may write anything).
/// @param now_ms  Unix time, for the estimated end
[[nodiscard]] std::optional<Progress> read_progress(std::string_view line, std::int64_t now_ms);

}  // namespace hydroprint::daemon
