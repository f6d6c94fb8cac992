#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/base/process/termination.h"
#include "sim/base/result.h"

namespace hydroprint::worker {

/// Options of a run that do not depend on the verb.
struct RunOptions {
  std::filesystem::path out;
  int threads = 1;
  bool json = false;
  int progress_fd = -1;                 ///< -1: no progress
  std::filesystem::path progress_file;  ///< empty: no progress
};

/// The output of a successful run.
struct Finished {
  std::string summary;                ///< text for stdout; JSON if RunOptions::json
  std::vector<std::string> warnings;  ///< for stderr, one line each
};

/// A computation with its options, ready to run.
class Task {
 public:
  Task() = default;
  virtual ~Task() = default;
  Task(const Task&) = delete;
  Task& operator=(const Task&) = delete;

  /// Returns the main input for error messages: a file name, or the verb's name if it reads no
  /// file.
  [[nodiscard]] virtual std::string subject() const = 0;
  /// Returns what to use if memory runs out, for the message "Use ... or more memory".
  [[nodiscard]] virtual std::string memory_tip() const { return "a smaller model"; }

  /// Runs the task to its end. Reports progress to `progress_fd` or `progress_file` of the options
  /// and, if `stderr_fd` is a terminal, also there. On failure no files remain.
  [[nodiscard]] virtual Result<Finished> run(const RunOptions& options, Termination& termination,
                                             int stderr_fd) = 0;
};

}  // namespace hydroprint::worker
