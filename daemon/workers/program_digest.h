#pragma once

#include <filesystem>
#include <mutex>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::daemon {

/// The hash of the worker program, recomputed only when the file has changed. Thread-safe.
class ProgramDigest {
 public:
  explicit ProgramDigest(std::filesystem::path path) : path_(std::move(path)) {}

  /// Returns the SHA-256, hex; kInternal, WORKER_UNUSABLE if the program does not exist.
  [[nodiscard]] Result<std::string> get();

 private:
  std::mutex mutex_;
  std::filesystem::path path_;
  std::string stamp_, digest_;
};

}  // namespace hydroprint::daemon
