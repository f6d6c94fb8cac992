#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/confine/sandbox.h"
#include "daemon/platform/durable_file.h"

namespace hydroprint::daemon {

/// Returns the flags of hydroprint-worker for a spec file; the input files are in the working
/// directory.
[[nodiscard]] std::vector<std::string> spec_options(const std::filesystem::path& spec_file);

/// A program to run, with its folders and limits.
struct Launch {
  std::filesystem::path program;
  std::vector<std::string> arguments = {};  ///< without the program's name
  std::filesystem::path inputs = {};        ///< working directory, which the program may read
  std::filesystem::path work = {};          ///< the only folder that the program may write to
  confine::Limits limits = {};
  std::filesystem::path confine_program = {};  ///< hydroprint-confine; needed if `confined`
  std::vector<std::string> environment = {};   ///< more variables, "NAME=value"
  int threads = 1;                             ///< number of cores that the program uses
  std::string build_id = {};                   ///< of the program, see ProgramDigest
  std::int64_t written_bytes = 0;              ///< most that it may write in all; 0: unlimited
  bool is_asked = false;                       ///< true: the program reads requests from stdin
  bool confined = true;  ///< false: only resource limits; for trusted programs that need a device
  /// Least nice value of the program: the rig and the daemon's responses have priority over it.
  int niceness = 10;
};

/// The flag of hydroprint-confine for confine::Limits::needs_landlock = false.
inline constexpr const char* kAllowWithoutLandlock = "--allow-without-landlock";

/// Returns the command that runs a program: its own, or that of hydroprint-confine.
[[nodiscard]] std::vector<std::string> command_of(const Launch& what);

/// A running worker. It leads its own process group, and is killed when the thread that started it
/// ends. The non-blocking pipes carry its progress, stderr (`errors`) and stdout (`answer`).
struct ChildProcess {
  pid_t pid = -1;
  UniqueFd handle;  ///< becomes readable when the worker ends
  UniqueFd progress;
  UniqueFd errors;
  UniqueFd answer;
  UniqueFd requests;  ///< the worker's stdin, if Launch::is_asked
};

/// The descriptor of the progress pipe in the worker.
inline constexpr int kProgressFd = 3;

/// Launch::niceness of programs that own the camera, which drops frames if they are late.
inline constexpr int kCameraNiceness = 5;

/// Starts a worker, confined unless Launch::confined is false. The calling thread must outlive the
/// worker.
/// @return kInternal, WORKER_UNUSABLE if the system cannot create a process. A program that cannot
/// be run exits at once with status 127 and a message at `errors`.
[[nodiscard]] Result<ChildProcess> launch(const Launch& what);

/// Checks whether programs can be confined.
/// @param needs_landlock  as in confine::Limits
/// @return a warning, which says what workers can do without Landlock; empty if the kernel has it.
///         kFailedPrecondition if the kernel does not allow the confinement or `confine_program`
///         cannot be run.
[[nodiscard]] Result<std::string> check_confinement(const std::filesystem::path& confine_program,
                                                    bool needs_landlock);

/// Sends a signal to the worker and all its children.
void signal_group(const ChildProcess& worker, int signal);

/// Waits until the worker ends, at most for `patience`.
/// @return the status from waitpid(); nullopt if it is still running
[[nodiscard]] std::optional<int> wait_for_end(const ChildProcess& worker,
                                              std::chrono::milliseconds patience = {});

/// Kills the worker and all its children.
/// @return the status from waitpid()
int kill_and_wait(const ChildProcess& worker);

/// Appends the available bytes of a pipe to `bytes`, up to `most` or slightly more. Returns false
/// at the end of the pipe.
[[nodiscard]] bool drain(const UniqueFd& pipe, std::string& bytes, std::size_t most);

/// Returns the resident memory of the worker in bytes; 0 if it has ended.
[[nodiscard]] std::int64_t resident_bytes(const ChildProcess& worker);

/// Returns the bytes that the worker has written to files and pipes, also through mapped memory,
/// as far as /proc tells; nullopt if it does not.
[[nodiscard]] std::optional<std::int64_t> written_bytes(const ChildProcess& worker);

}  // namespace hydroprint::daemon
