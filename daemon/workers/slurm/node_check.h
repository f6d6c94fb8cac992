#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/platform/check_line.h"

namespace hydroprint::daemon::slurm {

/// A node of the cluster.
struct Node {
  std::string name;
  std::string state;  ///< Slurm's word, for example "idle" or "down*"

  bool operator==(const Node&) const = default;
};

/// Returns whether the node can run jobs, now or when it has finished others.
[[nodiscard]] bool is_available(const Node& node);

/// Returns the command that lists the nodes of a partition; empty: of all partitions.
[[nodiscard]] std::vector<std::string> node_list_command(const std::string& partition);

/// Parses the output of node_list_command(). Without a partition, keeps the nodes of the default
/// partition.
/// @return nullopt if the output is anything else
[[nodiscard]] std::optional<std::vector<Node>> parse_node_list(std::string_view output,
                                                               const std::string& partition);

/// What the nodes must have.
struct NodeRequirements {
  std::filesystem::path worker;           ///< the worker program
  std::string build_id;                   ///< of the worker; empty: unknown
  std::filesystem::path confine_program;  ///< hydroprint-confine
  bool needs_landlock = true;             ///< as in confine::Limits
};

/// Returns the script that checks the node whose name is its argument. It writes its findings to
/// findings_file(), and fails if the folder is not there or lacks token_file().
/// @param options  of sbatch
[[nodiscard]] std::string node_check_script(const NodeRequirements& required,
                                            const std::filesystem::path& folder,
                                            const std::vector<std::string>& options);

/// Returns the file by which nodes recognize the shared folder of a check.
[[nodiscard]] std::filesystem::path token_file(const std::filesystem::path& folder);
/// Returns the file of the findings of one node.
[[nodiscard]] std::filesystem::path findings_file(const std::filesystem::path& folder,
                                                  const std::string& node);

/// The findings of the script.
struct NodeFindings {
  std::int64_t clock_s = 0;          ///< the node's clock, since 1970
  bool has_worker = false;           ///< the worker program exists
  std::string build_id;              ///< of the worker; empty if it prints none
  std::string confine_error;         ///< why workers cannot be confined; empty: they can
  std::string confine_warning = {};  ///< what they can do without Landlock; empty: it is there
};

/// Parses the findings; nullopt if malformed.
[[nodiscard]] std::optional<NodeFindings> parse_findings(std::string_view text);

/// Judges the findings of a node. A clock that differs is only a note, because nothing depends on
/// it.
/// @param asked_s, read_s  when the job was submitted and its findings were read, by this machine's
///                         clock
[[nodiscard]] CheckLine judge_node(const std::string& node, const NodeFindings& findings,
                                   const NodeRequirements& required, std::int64_t asked_s,
                                   std::int64_t read_s);

}  // namespace hydroprint::daemon::slurm
