#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hydroprint::daemon::slurm {

/// What Slurm does with a job.
enum class Phase : std::uint8_t { kWaits, kRuns, kEnded };

/// Slurm's word on one job.
struct QueueEntry {
  Phase phase = Phase::kRuns;
  std::string state;   ///< Slurm's name of the state, for example "TIMEOUT"
  std::string reason;  ///< Slurm's reason, for example "Resources"; "None" without one
};

/// Slurm's word on jobs, by their names.
using Queue = std::map<std::string, QueueEntry>;

/// Returns the name of the job of an execution, from its folder INSTALLATION/JOB-ATTEMPT:
/// hydroprint-INSTALLATION-JOB-ATTEMPT. Ids of Slurm are not used, because a controller that was
/// killed gives them out again.
[[nodiscard]] std::string job_name(const std::filesystem::path& folder);

/// Returns the command that asks for all jobs of the user, ended ones too, as long as Slurm
/// remembers them (MinJobAge, 300 s unless configured).
[[nodiscard]] std::vector<std::string> queue_command();

/// Parses the output of queue_command(); keeps jobs whose name is one of job_name(). Of several
/// jobs with one name, the one that runs counts most, the one that has ended least.
/// @return nullopt if the output is anything else
[[nodiscard]] std::optional<Queue> parse_queue(std::string_view output);

}  // namespace hydroprint::daemon::slurm
