#pragma once

namespace hydroprint::worker {

/// Keeps what libraries print from the process's stderr, where one line per error is promised:
/// while it lives, descriptor 2 leads nowhere (but for builds with sanitizers, whose reports go
/// there).
class QuietStderr {
 public:
  QuietStderr();
  ~QuietStderr();
  QuietStderr(const QuietStderr&) = delete;
  QuietStderr& operator=(const QuietStderr&) = delete;

  /// The stderr that the process was given.
  [[nodiscard]] int own() const { return own_; }
  /// Gives it back.
  void restore() const;

 private:
  int own_;
};

}  // namespace hydroprint::worker
