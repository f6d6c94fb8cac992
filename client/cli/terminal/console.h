#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "sim/base/number_text.h"

namespace hydroprint::cli {

/// Replaces control characters with spaces, so that names cannot move a terminal's cursor.
[[nodiscard]] std::string printable(std::string_view text);

/// Formats a time as local time, "2026-03-01 14:05:09"; "-" for nullopt.
[[nodiscard]] std::string format_time(
    const std::optional<std::chrono::system_clock::time_point>& time);

/// Formats millimetres or millimetres per second: "0.05", "-12.30".
[[nodiscard]] std::string format_fixed(double value);

/// A line at the bottom of a terminal that is updated in place.
class LiveLine {
 public:
  /// @param descriptor  if it is not a terminal, the live line is never shown
  explicit LiveLine(int descriptor);
  ~LiveLine() { clear(); }
  LiveLine(const LiveLine&) = delete;
  LiveLine& operator=(const LiveLine&) = delete;

  [[nodiscard]] bool is_terminal() const { return is_terminal_; }
  void show(const std::string& text);
  /// Erases the line.
  void clear();
  /// Prints a permanent line above the live one, also if the descriptor is not a terminal.
  void say(const std::string& text);

 private:
  void write(const std::string& text) const;

  int descriptor_;
  bool is_terminal_;
  bool shown_ = false;
};

/// A live line with a progress bar.
class ProgressLine {
 public:
  explicit ProgressLine(int descriptor) : line_(descriptor) {}

  [[nodiscard]] bool is_terminal() const { return line_.is_terminal(); }
  /// Shows "label [####----]  48%  text".
  void show(const std::string& label, double fraction, const std::string& text);
  /// Erases the line.
  void clear() { line_.clear(); }
  /// Prints a permanent line above the live one, also if the descriptor is not a terminal.
  void say(const std::string& text) { line_.say(text); }

 private:
  LiveLine line_;
};

}  // namespace hydroprint::cli
