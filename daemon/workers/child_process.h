#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/platform/durable_file.h"
#include "daemon/workers/sandbox.h"

namespace hydroprint::daemon {

/// Flags of hydroprint-worker for a spec file; the files that it names are in the working folder.
[[nodiscard]] std::vector<std::string> spec_options(const std::filesystem::path& spec_file);

/// What to run and where.
struct Launch {
  std::filesystem::path program;
  std::vector<std::string> arguments;  ///< without the program's name
  std::filesystem::path inputs;        ///< working folder: what it may read
  std::filesystem::path work;          ///< the only folder it may write in
  Limits limits;
  bool is_asked = false;  ///< true: it reads requests on stdin
  bool confined = true;   ///< false: of limits alone; for a program of ours that needs a device
};

/// A running worker: leader of a process group of its own, which dies with the thread that started
/// it. Its progress arrives at `progress`, its words at `errors` and what it prints at `answer`,
/// none of which ever blocks.
struct ChildProcess {
  pid_t pid = -1;
  UniqueFd handle;  ///< becomes readable when it ends
  UniqueFd progress;
  UniqueFd errors;
  UniqueFd answer;
  UniqueFd requests;  ///< its stdin, if it is asked
};

/// The file descriptor that a worker finds its progress pipe at.
inline constexpr int kProgressFd = 3;

/// Starts a confined worker. The calling thread must outlive it.
/// @return kInternal, WORKER_UNUSABLE if the system has no room for another process; a program that
///   cannot be run ends at once with status 127 and says so at `errors`
[[nodiscard]] Result<ChildProcess> launch(const Launch& what, const Sandbox& sandbox);

/// Sends a signal to the worker and all its children.
void signal_group(const ChildProcess& worker, int signal);

/// Ends it and all its children at once.
/// @return as waitpid() gives it
int kill_and_wait(const ChildProcess& worker);

/// Appends what there is to read now, `most` bytes or a little more; false at the end of the pipe.
[[nodiscard]] bool drain(const UniqueFd& pipe, std::string& bytes, std::size_t most);

/// Bytes the worker has in memory now; 0 if it is gone.
[[nodiscard]] std::int64_t resident_bytes(const ChildProcess& worker);

}  // namespace hydroprint::daemon
