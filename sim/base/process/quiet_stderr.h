#pragma once

namespace hydroprint::worker {

/// Hides library output on the process's stderr, where one line per error is promised. While it
/// exists, descriptor 2 is /dev/null, except in sanitizer builds, whose reports go there.
class QuietStderr {
 public:
  QuietStderr();
  ~QuietStderr();
  QuietStderr(const QuietStderr&) = delete;
  QuietStderr& operator=(const QuietStderr&) = delete;

  /// The process's original stderr.
  [[nodiscard]] int own() const { return own_; }
  /// Restores the original stderr.
  void restore() const;

 private:
  int own_;
};

}  // namespace hydroprint::worker
