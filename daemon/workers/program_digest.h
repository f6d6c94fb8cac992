#pragma once

#include <filesystem>
#include <mutex>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// The build id of the worker program: equal on two machines if the same worker is installed.
/// Recomputed only when the program or one of its modules, hydroprint-*.so in its folder, has
/// changed. Thread-safe.
class ProgramDigest {
 public:
  explicit ProgramDigest(std::filesystem::path path) : path_(std::move(path)) {}

  /// Returns what the program prints with `--version --json`; the SHA-256 of its file if it prints
  /// no build id, as a script would. Hex. Errors: kInternal, WORKER_UNUSABLE if the program does
  /// not exist.
  [[nodiscard]] Result<std::string> get();

 private:
  std::mutex mutex_;
  std::filesystem::path path_;
  std::string stamp_, digest_;
};

}  // namespace hydroprint::daemon
