#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/platform/durable_file.h"
#include "daemon/workers/sandbox.h"

namespace hydroprint::daemon {

/// Returns the flags of hydroprint-worker for a spec file; the input files are in the working
/// directory.
[[nodiscard]] std::vector<std::string> spec_options(const std::filesystem::path& spec_file);

/// The program to run, and its environment.
struct Launch {
  std::filesystem::path program;
  std::vector<std::string> arguments;  ///< without the program's name
  std::filesystem::path inputs;        ///< working directory, which it may read
  std::filesystem::path work;          ///< the only folder that it may write to
  Limits limits;
  bool is_asked = false;  ///< true: it reads requests from stdin
  bool confined = true;   ///< false: only limits apply; for trusted programs that need a device
};

/// A running worker. It leads its own process group, which is killed when the thread that started
/// it ends. The non-blocking pipes carry its progress, stderr (`errors`) and stdout (`answer`).
struct ChildProcess {
  pid_t pid = -1;
  UniqueFd handle;  ///< becomes readable when the worker ends
  UniqueFd progress;
  UniqueFd errors;
  UniqueFd answer;
  UniqueFd requests;  ///< its stdin, if `is_asked`
};

/// The descriptor of the progress pipe in the worker.
inline constexpr int kProgressFd = 3;

/// Starts a confined worker. The calling thread must outlive it.
/// @return kInternal, WORKER_UNUSABLE if the system cannot create a process. A program that cannot
/// be run exits at once with status 127 and a message at `errors`.
[[nodiscard]] Result<ChildProcess> launch(const Launch& what, const Sandbox& sandbox);

/// Sends a signal to the worker and all its children.
void signal_group(const ChildProcess& worker, int signal);

/// Waits until the worker ends, at most for `patience`.
/// @return the status from waitpid(); nullopt if it is still running
[[nodiscard]] std::optional<int> wait_for_end(const ChildProcess& worker,
                                              std::chrono::milliseconds patience = {});

/// Kills the worker and all its children.
/// @return the status from waitpid()
int kill_and_wait(const ChildProcess& worker);

/// Appends the available bytes, up to `most` or slightly more; returns false at the end of the
/// pipe.
[[nodiscard]] bool drain(const UniqueFd& pipe, std::string& bytes, std::size_t most);

/// Returns the resident memory of the worker in bytes; 0 if it has ended.
[[nodiscard]] std::int64_t resident_bytes(const ChildProcess& worker);

}  // namespace hydroprint::daemon
