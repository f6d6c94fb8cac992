#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "daemon/workers/slurm/node_check.h"
#include "daemon/workers/slurm/settings.h"

namespace hydroprint::daemon::slurm {

/// For one program of Slurm, which gives up after 10 s if the controller does not answer.
inline constexpr std::chrono::seconds kSlurmPatience{12};

/// The caller of a check that takes long.
struct CheckCaller {
  std::function<void(const CheckLine&)> add;  ///< gets each line of the result
  /// Gets the number of nodes that have not answered yet, several times a second.
  std::function<void(std::size_t)> wait_for = [](std::size_t) {};
  std::function<bool()> is_cancelled = [] { return false; };
};

/// Checks nodes by one short job on each, at the same time. A node that does not answer in time,
/// because it is busy, gets a note. All jobs have ended or are cancelled at the end.
/// @param folder    an empty folder that the nodes share; filled with files
/// @param patience  for the answers of all nodes
/// @return an error if the folder cannot be written
[[nodiscard]] Status check_nodes(const Settings& settings, const NodeRequirements& required,
                                 const std::vector<Node>& nodes,
                                 const std::filesystem::path& folder,
                                 std::chrono::milliseconds patience, const CheckCaller& caller);

}  // namespace hydroprint::daemon::slurm
