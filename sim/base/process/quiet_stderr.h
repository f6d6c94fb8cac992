#pragma once

namespace hydroprint::worker {

/// Redirects the process's stderr to /dev/null during its lifetime, so that messages of libraries
/// do not mix with the one line per error. Sanitizer builds are not redirected, because their
/// reports go to stderr.
class QuietStderr {
 public:
  QuietStderr();
  ~QuietStderr();
  QuietStderr(const QuietStderr&) = delete;
  QuietStderr& operator=(const QuietStderr&) = delete;

  /// Returns the descriptor of the process's original stderr.
  [[nodiscard]] int own() const { return own_; }
  /// Restores the original stderr.
  void restore() const;

 private:
  int own_;
};

}  // namespace hydroprint::worker
