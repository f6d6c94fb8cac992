#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "daemon/workers/child_process.h"

namespace hydroprint::daemon {

/// How a program ended.
struct CommandEnd {
  int status = -1;       ///< exit status; -1: killed by a signal, or by us because it took too long
  bool is_late = false;  ///< killed by us
  std::string output = {};  ///< its stdout
  std::string errors = {};  ///< last line of its stderr
};

/// One run of a trusted program of this machine, which may hang or print anything. It is killed
/// with the object.
class CommandRun {
 public:
  /// Starts a program with the environment of a worker, and the daemon's SLURM_CONF.
  /// @param command   path of the program, or its name, which is looked up in PATH; its arguments
  /// @param folder    working directory, and home of the program
  /// @param patience  the program is killed after this time
  /// @return kFailedPrecondition, WORKER_UNUSABLE if the program does not exist
  [[nodiscard]] static Result<CommandRun> start(const std::vector<std::string>& command,
                                                const std::filesystem::path& folder,
                                                std::chrono::milliseconds patience);
  ~CommandRun();
  CommandRun(CommandRun&& other) noexcept;
  CommandRun& operator=(CommandRun&&) = delete;

  /// Returns the end, once; nullopt while the program runs. Does not wait.
  [[nodiscard]] std::optional<CommandEnd> poll();
  /// Waits for the end.
  [[nodiscard]] CommandEnd wait();
  /// Returns the descriptors that become readable when poll() has something to do.
  [[nodiscard]] std::vector<int> descriptors() const;

 private:
  CommandRun() = default;
  void read();

  ChildProcess process_;
  std::chrono::steady_clock::time_point deadline_;
  std::string output_, errors_;
};

/// Runs a program to its end; see CommandRun::start().
[[nodiscard]] Result<CommandEnd> run_command(const std::vector<std::string>& command,
                                             const std::filesystem::path& folder,
                                             std::chrono::milliseconds patience);

}  // namespace hydroprint::daemon
