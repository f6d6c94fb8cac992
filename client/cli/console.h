#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hydroprint::cli {

/// Without control characters, so that no name can move a terminal's cursor.
[[nodiscard]] std::string printable(std::string_view text);

/// "0:07", "12:30", "1:02:03".
[[nodiscard]] std::string format_duration(std::chrono::seconds time);

/// "312 B", "4.2 MB".
[[nodiscard]] std::string format_bytes(std::int64_t bytes);

/// Local time, "2026-03-01 14:05:09"; "-" for none.
[[nodiscard]] std::string format_time(
    const std::optional<std::chrono::system_clock::time_point>& time);

/// UTC, RFC 3339, for JSON.
[[nodiscard]] std::string format_rfc3339(std::chrono::system_clock::time_point time);

/// One line at the bottom of a terminal that is written over again and again, with a bar.
class ProgressLine {
 public:
  /// @param descriptor  of the terminal; if it is none, nothing is ever shown
  explicit ProgressLine(int descriptor);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  [[nodiscard]] bool is_terminal() const { return is_terminal_; }
  /// "label [####----]  48%  text"
  void show(const std::string& label, double fraction, const std::string& text);
  /// Takes the line away.
  void clear();

 private:
  void write(const std::string& text) const;

  int descriptor_;
  bool is_terminal_;
  bool shown_ = false;
};

}  // namespace hydroprint::cli
