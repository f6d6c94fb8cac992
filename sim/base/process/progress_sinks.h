#pragma once

#include "sim/base/process/progress.h"

namespace hydroprint::worker {

/// Writes reports to a pipe, one JSON object a line (contract, `--progress-fd`):
/// {"stage":"velocity","fraction":0.42,"total_fraction":0.31,"eta_s":3.1}; eta_s is null while
/// unknown. A reader that is slow misses lines; one that has gone is written to no more.
class ProgressPipe {
 public:
  explicit ProgressPipe(int fd) : fd_(fd) {}
  void write(const ProgressReport& report);

 private:
  int fd_;
};

/// Keeps one line for people on a terminal: bar, stage, time left. Not a terminal: says nothing.
class ProgressLine {
 public:
  explicit ProgressLine(int fd);
  /// Leaves the line empty for what is to be said next.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  void show(const ProgressReport& report) const;

 private:
  int fd_;
};

}  // namespace hydroprint::worker
