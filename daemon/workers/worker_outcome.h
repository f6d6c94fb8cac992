#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/store/job.h"

namespace hydroprint::daemon {

/// Why the pool stopped a worker, if it did.
enum class StopReason { kNothing, kCancel, kShutdown, kTime, kMemory, kOutput };

/// Returns the last non-empty line of a worker's stderr, made safe for one line of text.
[[nodiscard]] std::string last_line(std::string_view errors);

/// Reads the Failure that a program printed. Nullopt if it is not a valid one; its texts are made
/// safe for one line, because the program is untrusted.
[[nodiscard]] std::optional<Error> read_failure(const nlohmann::json& json);

/// Translates the end of a worker to its job's failure; nullopt if it succeeded.
/// @param wait_status  from waitpid()
/// @param errors       its stderr
/// @param answer       its stdout, which with --json ends with {"error": Failure}
[[nodiscard]] std::optional<JobFailure> judge(int wait_status, StopReason stopped,
                                              std::string_view errors,
                                              std::string_view answer = {});

/// Removes the complete lines from the received bytes of a worker's progress and returns them.
/// Lines that are too long are dropped, because the worker is untrusted.
[[nodiscard]] std::vector<std::string> take_progress_lines(std::string& received);

/// Returns the progress of a job that waits before its worker computes.
/// @param reason  what for, in words: that of an engine with a queue of its own
[[nodiscard]] Progress waiting_progress(std::string_view reason);

/// Parses one line of a worker's progress; nullopt if it is malformed. The line is untrusted, since
/// a hostile file may have compromised the worker.
/// @param now_ms  Unix time, for the estimated end
[[nodiscard]] std::optional<Progress> read_progress(std::string_view line, std::int64_t now_ms);

}  // namespace hydroprint::daemon
