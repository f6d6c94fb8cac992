#include "daemon/workers/worker_outcome.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstring>

#include "daemon/rest/json_text.h"
#include "hydroprint/v1/failure.pb.h"
#include "sim/base/checked_json.h"

namespace hydroprint::daemon {
namespace {

constexpr std::size_t kLongestMessage = 1000;
constexpr std::size_t kLongestPhase = 64;
constexpr std::size_t kLongestField = 200;
constexpr std::size_t kLongestLine = 4 << 10;  // of progress

// Keeps printable ASCII and well-formed UTF-8; replaces all other bytes with '?'.
std::string printable(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto c = static_cast<unsigned char>(text[i]);
    std::size_t length = c < 0x80 ? 1 : c >= 0xc2 && c < 0xe0 ? 2 : c >= 0xe0 && c < 0xf0 ? 3 : 0;
    bool good = length != 0 && i + length <= text.size() && c >= ' ' && c != 0x7f;
    for (std::size_t j = 1; good && j < length; ++j) {
      good = (static_cast<unsigned char>(text[i + j]) & 0xc0) == 0x80;
    }
    // Excludes overlong forms, surrogates and C1 controls.
    if (good && length > 1) {
      const auto d = static_cast<unsigned char>(text[i + 1]);
      good = !(c == 0xe0 && d < 0xa0) && !(c == 0xed && d >= 0xa0) && !(c == 0xc2 && d < 0xa0);
    }
    if (!good) length = 1;
    out += good ? std::string(text.substr(i, length)) : "?";
    i += length;
  }
  return out;
}

// Returns the last non-empty line.
std::string_view last_of(std::string_view text) {
  text = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
  return text.substr(text.rfind('\n') + 1);
}

// Truncates a text at a character boundary.
std::string shortened(std::string text, std::size_t longest) {
  if (text.size() <= longest) return text;
  while (longest > 0 && (static_cast<unsigned char>(text[longest]) & 0xc0) == 0x80) --longest;
  return text.substr(0, longest);
}

JobFailure failure(Code code, ErrorReason reason, std::string message) {
  return {{code, std::move(message), reason}, {}, {}};
}

JobFailure memory_failure() {
  return failure(Code::kResourceExhausted, ErrorReason::MEMORY_LIMIT,
                 "the worker exceeded its memory limit; simplify the model, lower dpi, or "
                 "raise workers.memory_mib");
}

JobFailure time_failure() {
  return failure(Code::kResourceExhausted, ErrorReason::TIME_LIMIT,
                 "the worker exceeded its time limit; simplify the model, lower dpi, or raise "
                 "workers.time_limit_s");
}

JobFailure disk_failure() {
  return failure(
      Code::kResourceExhausted, ErrorReason::DISK_FULL,
      "the artifacts do not fit on the daemon's disk; delete jobs or assets, free disk space, "
      "or lower dpi, and retry");
}

JobFailure output_failure() {
  return failure(Code::kResourceExhausted, ErrorReason::OUTPUT_LIMIT,
                 "the worker exceeded its limit on file size; lower dpi or raise "
                 "workers.file_mib");
}

// Judges an exit status. `message` is the program's own; `words`, its last ones on stderr, are
// shown where a program has no message, because it did not start or ended unexpectedly.
JobFailure judge_exit(int status, const std::string& message, const std::string& words) {
  switch (status) {
    case 2:
    case 3:
      return failure(Code::kInvalidArgument, ErrorReason::INPUT_REFUSED,
                     message.empty() ? "the worker refused its input without a message" : message);
    case 4:
      return failure(Code::kInternal, ErrorReason::COMPUTATION_FAILED,
                     message.empty() ? "the computation failed without a message" : message);
    case 127:
      return failure(Code::kInternal, ErrorReason::WORKER_UNUSABLE,
                     words.empty() ? "the worker cannot be started; check workers.program" : words);
    case 130:
      return failure(Code::kCancelled, ErrorReason::WORKER_KILLED,
                     "the worker was interrupted by a signal; try again");
    default:
      return failure(Code::kInternal, ErrorReason::COMPUTATION_FAILED,
                     fmt::format("the worker ended with status {}{}{}", status,
                                 words.empty() ? "" : ": ", words));
  }
}

JobFailure judge_signal(int signal) {
  if (signal == SIGXCPU) return time_failure();
  if (signal == SIGXFSZ) return output_failure();
  if (signal == SIGKILL || signal == SIGTERM) {
    return failure(Code::kInternal, ErrorReason::WORKER_KILLED,
                   fmt::format("the worker was killed (signal {}) by a user, or because memory "
                               "ran out; try again",
                               signal));
  }
  return failure(Code::kInternal, ErrorReason::WORKER_KILLED,
                 fmt::format("the worker crashed (signal {}, {}); please report the crash together "
                             "with the model",
                             signal, ::strsignal(signal)));
}

// Translates limits of the machine and of the worker; nullopt for other reasons.
std::optional<JobFailure> limit_failure(ErrorReason reason) {
  if (reason == ErrorReason::MEMORY_LIMIT) return memory_failure();
  if (reason == ErrorReason::DISK_FULL) return disk_failure();
  if (reason == ErrorReason::OUTPUT_LIMIT) return output_failure();
  return std::nullopt;
}

// Returns the failure of a program that ended by itself with a nonzero status.
JobFailure judge_failed_exit(int status, const std::string& words, std::string_view answer) {
  const auto object = parse_json(last_of(answer)).value_or(nullptr);
  const Error printed = read_failure(json_at(object, "error")).value_or(Error{});
  if (auto failure = limit_failure(printed.reason)) return *std::move(failure);
  JobFailure out = judge_exit(status, printed.message, words);
  out.error.field = printed.field;
  const bool is_general = out.error.reason == ErrorReason::INPUT_REFUSED ||
                          out.error.reason == ErrorReason::COMPUTATION_FAILED;
  if (is_general && printed.reason != ErrorReason{}) out.error.reason = printed.reason;
  return out;
}

}  // namespace

std::string last_line(std::string_view errors) {
  return shortened(printable(last_of(errors)), kLongestMessage);
}

std::optional<Error> read_failure(const nlohmann::json& json) {
  v1::Failure failure;
  if (!json.is_object() || !rest::read_json(json.dump(), failure, "failure")) return {};
  Error out{Code::kInternal, shortened(printable(failure.message()), kLongestMessage)};
  out.reason = static_cast<ErrorReason>(failure.reason());
  out.field = shortened(printable(failure.field()), kLongestField);
  return out;
}

std::optional<JobFailure> judge(int wait_status, StopReason stopped, std::string_view errors,
                                std::string_view answer) {
  const std::string words = last_line(errors);
  if (WIFEXITED(wait_status) && WEXITSTATUS(wait_status) == 0) return std::nullopt;
  JobFailure out;
  if (stopped == StopReason::kTime) {
    out = time_failure();
  } else if (stopped == StopReason::kOutput) {
    out = output_failure();
  } else if (stopped == StopReason::kMemory) {
    out = memory_failure();
  } else if (WIFEXITED(wait_status)) {
    out = judge_failed_exit(WEXITSTATUS(wait_status), words, answer);
  } else {
    out = judge_signal(WTERMSIG(wait_status));
  }
  if (WIFEXITED(wait_status)) out.exit_status = WEXITSTATUS(wait_status);
  if (WIFSIGNALED(wait_status)) out.signal = WTERMSIG(wait_status);
  return out;
}

std::vector<std::string> take_progress_lines(std::string& received) {
  std::vector<std::string> lines;
  std::size_t begin = 0;
  for (std::size_t end = 0; (end = received.find('\n', begin)) != std::string::npos;
       begin = end + 1) {
    if (end - begin <= kLongestLine) lines.push_back(received.substr(begin, end - begin));
  }
  received.erase(0, begin);
  if (received.size() > kLongestLine) received.clear();
  return lines;
}

Progress waiting_progress(std::string_view reason) {
  Progress progress;
  progress.waits_for = shortened(printable(reason), kLongestPhase);
  return progress;
}

std::optional<Progress> read_progress(std::string_view line, std::int64_t now_ms) {
  const auto object = parse_json(line, {.depth = 1}).value_or(nullptr);
  const auto stage = json_string(object, "stage");
  const auto total = json_number(object, "total_fraction");
  if (!stage || !total) return std::nullopt;
  Progress progress;
  progress.fraction = std::clamp(*total, 0.0, 1.0);
  progress.phase = shortened(printable(*stage), kLongestPhase);
  progress.phase_fraction = std::clamp(json_number(object, "fraction").value_or(0), 0.0, 1.0);
  constexpr double kLongestEta_s = 30.0 * 24 * 3600;
  const double eta_s = json_number(object, "eta_s").value_or(-1);
  if (eta_s >= 0 && eta_s <= kLongestEta_s) {
    progress.eta_ms = now_ms + static_cast<std::int64_t>(eta_s * 1000);
  }
  return progress;
}

}  // namespace hydroprint::daemon
