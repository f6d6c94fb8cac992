#pragma once

#include "sim/base/process/progress.h"

namespace hydroprint::worker {

/// Writes reports to a pipe, one JSON object per line (contract, `--progress-fd`):
/// {"stage":"velocity","fraction":0.42,"total_fraction":0.31,"eta_s":3.1}; eta_s is null while
/// unknown. A slow reader misses lines. Writing stops when the reader is gone.
class ProgressPipe {
 public:
  explicit ProgressPipe(int fd) : fd_(fd) {}
  void write(const ProgressReport& report);

 private:
  int fd_;
};

/// Shows one progress line on a terminal: bar, stage, time left. Prints nothing elsewhere.
class ProgressLine {
 public:
  explicit ProgressLine(int fd);
  /// Clears the line for the output that follows.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  void show(const ProgressReport& report) const;

 private:
  int fd_;
};

}  // namespace hydroprint::worker
