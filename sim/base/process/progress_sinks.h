#pragma once

#include "sim/base/process/progress.h"

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
