#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <utility>

#include "sim/base/process/progress.h"
#include "sim/base/result.h"

namespace hydroprint::worker {

/// Writes reports to a pipe (option `--progress-fd`), one JSON object per line:
/// {"stage":"velocity","fraction":0.42,"total_fraction":0.31,"eta_s":3.1}; eta_s is null while
/// unknown. Lines are dropped if the reader is slow. Writing stops when the reader closes the pipe.
class ProgressPipe {
 public:
  explicit ProgressPipe(int fd) : fd_(fd) {}
  void write(const ProgressReport& report);

 private:
  int fd_;
};

/// Collects reports as the lines of ProgressPipe and appends them to a file (option
/// `--progress-file`), which another machine may read over a shared file system. The file is never
/// rewritten, and each append is one write of whole lines, so a reader can remember its offset. The
/// last line is repeated now and then, so that the reader knows that the program still runs.
class ProgressFile {
 public:
  /// Creates the file unless it exists. Error: kInvalidArgument if that is impossible.
  [[nodiscard]] static Status create(const std::filesystem::path& path);

  /// @param path  an existing file; empty: no progress
  explicit ProgressFile(std::filesystem::path path) : path_(std::move(path)) {}
  void write(const ProgressReport& report);
  /// Number of calls of append() without a new report after which the last one is repeated: 20 s
  /// with four calls a second.
  static constexpr int kRepeatAfter = 80;

  /// Appends the reports since the last call. Drops them if that fails. May be called from another
  /// thread than write(), which does not wait for the disk.
  void append();

 private:
  std::filesystem::path path_;
  std::mutex mutex_;
  std::string pending_;
  std::string last_;  // the last line; used only by append(), as the next
  int idle_calls_ = 0;
};

/// Shows a progress line with bar, stage and time left. Prints only to a terminal.
class ProgressLine {
 public:
  explicit ProgressLine(int fd);
  /// Clears the line, so that other output can follow.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  void show(const ProgressReport& report) const;

 private:
  int fd_;
};

}  // namespace hydroprint::worker
