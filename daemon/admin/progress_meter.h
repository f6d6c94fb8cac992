#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace hydroprint::admin {

/// Formats a size for display: "1.4 GB".
[[nodiscard]] std::string bytes_text(std::int64_t bytes);

/// Shows progress and the remaining time on stderr: on a terminal, a line that is updated in place;
/// elsewhere, a new line every ten seconds.
class ProgressMeter {
 public:
  /// @param what  name of the operation: "backup"
  ProgressMeter(std::string what, std::int64_t total_bytes);
  /// Ends the line.
  ~ProgressMeter();
  ProgressMeter(const ProgressMeter&) = delete;
  ProgressMeter& operator=(const ProgressMeter&) = delete;

  void add(std::int64_t bytes);

 private:
  using Clock = std::chrono::steady_clock;

  std::string what_;
  std::int64_t total_bytes_, done_bytes_ = 0;
  bool is_terminal_;
  Clock::time_point begun_ = Clock::now(), shown_ = Clock::now();
  bool is_line_open_ = false;
};

}  // namespace hydroprint::admin
