#include "daemon/workers/slurm/queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace hydroprint::daemon::slurm {
namespace {

constexpr std::array<std::string_view, 10> kEndStates{
    "BOOT_FAIL", "CANCELLED",     "COMPLETED", "DEADLINE", "FAILED",
    "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED", "REVOKED",  "TIMEOUT"};
constexpr std::array<std::string_view, 7> kWaitStates{
    "PENDING",      "CONFIGURING",  "REQUEUED",     "REQUEUE_FED",
    "REQUEUE_HOLD", "SPECIAL_EXIT", "RESV_DEL_HOLD"};

Phase phase_of(std::string_view state) {
  const auto is_in = [state](const auto& states) {
    return std::find(states.begin(), states.end(), state) != states.end();
  };
  return is_in(kEndStates) ? Phase::kEnded : is_in(kWaitStates) ? Phase::kWaits : Phase::kRuns;
}

int rank(Phase phase) { return phase == Phase::kRuns ? 2 : phase == Phase::kWaits ? 1 : 0; }

constexpr std::string_view kPrefix = "hydroprint-";

// Removes the text before the next '|' and returns it.
std::optional<std::string_view> take_field(std::string_view& line) {
  const std::size_t bar = line.find('|');
  if (bar == std::string_view::npos) return std::nullopt;
  const std::string_view field = line.substr(0, bar);
  line.remove_prefix(bar + 1);
  return field;
}

bool is_number(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// Adds one line of the answer; returns false if it is not one.
bool add_line(std::string_view line, Queue& queue) {
  const auto id = take_field(line), state = take_field(line), reason = take_field(line);
  // The id of an array's task has more than digits, but such a job is not ours.
  if (!reason || id->empty() || !is_number(id->substr(0, 1)) || state->empty()) return false;
  if (!line.starts_with(kPrefix)) return true;
  const QueueEntry entry{phase_of(*state), std::string(*state), std::string(*reason)};
  const auto [at, is_new] = queue.try_emplace(std::string(line), entry);
  if (!is_new && rank(entry.phase) >= rank(at->second.phase)) at->second = entry;
  return true;
}

}  // namespace

std::string job_name(const std::filesystem::path& folder) {
  return fmt::format("{}{}-{}", kPrefix, folder.parent_path().filename().string(),
                     folder.filename().string());
}

std::vector<std::string> queue_command() {
  return {"squeue", "--me", "--noheader", "--states=all", "--sort=i", "--format=%i|%T|%r|%j"};
}

std::optional<Queue> parse_queue(std::string_view output) {
  Queue queue;
  while (!output.empty()) {
    const std::size_t end = output.find('\n');
    if (end == std::string_view::npos || !add_line(output.substr(0, end), queue))
      return std::nullopt;
    output.remove_prefix(end + 1);
  }
  return queue;
}

}  // namespace hydroprint::daemon::slurm
