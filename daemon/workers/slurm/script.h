#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hydroprint::daemon::slurm {

/// Returns the text as one word of a shell.
[[nodiscard]] std::string quoted(const std::string& text);

/// Returns the shell command that prints the build id of a worker; nothing if it has none.
[[nodiscard]] std::string print_build_id(const std::filesystem::path& worker);

/// Returns the lines of a script that pass options to sbatch.
[[nodiscard]] std::string option_lines(const std::vector<std::string>& options);

/// What the script of an execution does.
struct ScriptPlan {
  std::vector<std::string> options;  ///< of sbatch
  std::filesystem::path folder;      ///< the execution's, on the shared file system
  std::filesystem::path worker;      ///< the worker program, at the same path on all nodes
  std::string build_id;              ///< that the worker of the node has to have
  std::vector<std::string> command;  ///< runs the confined worker
  std::filesystem::path inputs;      ///< the worker's working directory
};

/// Returns the script that Slurm runs on a node. In the folder it leaves `begun` (a folder, so that
/// a second run of the script ends at once), `begin` (node, Slurm's id, build id), the worker's
/// `answer` and `errors`, and at last `exit` (see run_files.h). It goes on if it gets SIGTERM,
/// which Slurm sends to the worker as well.
[[nodiscard]] std::string batch_script(const ScriptPlan& plan);

}  // namespace hydroprint::daemon::slurm
