#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/store/state_layout.h"

namespace hydroprint::daemon::slurm {

/// Returns the file to which the worker appends its progress.
[[nodiscard]] std::filesystem::path progress_file(const RunFolder& folder);
/// Returns the script that is handed over to Slurm.
[[nodiscard]] std::filesystem::path script_file(const RunFolder& folder);

/// Returns whether the script of an execution has begun.
[[nodiscard]] bool has_begun(const RunFolder& folder);

/// Returns how the worker ended, as from waitpid(); nullopt as long as the script left no exit
/// file. Of the shell's statuses above 128, all except 130 (the worker's own, when it is cancelled)
/// are signals.
[[nodiscard]] std::optional<int> wait_status(const RunFolder& folder);

/// Returns the last bytes of the worker's stdout or stderr; empty if there are none.
[[nodiscard]] std::string answer_of(const RunFolder& folder);
[[nodiscard]] std::string errors_of(const RunFolder& folder);

/// Reads a file that grows, at the reader's own pace.
class ProgressReader {
 public:
  /// Returns the complete lines that were appended since the last call.
  [[nodiscard]] std::vector<std::string> lines(const RunFolder& folder);

 private:
  std::int64_t read_ = 0;  // bytes
  std::string received_;   // bytes of an incomplete line
};

}  // namespace hydroprint::daemon::slurm
