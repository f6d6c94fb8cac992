#include "client/cli/terminal/console.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "sim/base/one_line.h"

namespace hydroprint::cli {
namespace {

constexpr int kBarCells = 24;

std::string format(const char* form, auto... values) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), form, values...);
  return text.data();
}

std::string format_calendar(const char* form, const std::tm& time) {
  std::array<char, 64> text{};
  std::strftime(text.data(), text.size(), form, &time);
  return text.data();
}

std::size_t columns(int descriptor) {
  winsize size{};
  if (ioctl(descriptor, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

}  // namespace

std::string printable(std::string_view text) { return one_line(std::string(text)); }

std::string format_duration(std::chrono::seconds time) {
  const auto seconds = std::max<std::int64_t>(time.count(), 0);
  const auto hours = static_cast<int>(seconds / 3600);
  const auto minutes = static_cast<int>(seconds / 60 % 60);
  if (hours > 0) return format("%d:%02d:%02d", hours, minutes, static_cast<int>(seconds % 60));
  return format("%d:%02d", minutes, static_cast<int>(seconds % 60));
}

std::string format_bytes(std::int64_t bytes) {
  if (bytes < 1000) return std::to_string(bytes) + " B";
  double value = static_cast<double>(bytes);
  for (const char* unit : {"kB", "MB", "GB"}) {
    value /= 1000;
    if (value < 999.95) return format("%.1f %s", value, unit);
  }
  return format("%.1f TB", value / 1000);
}

std::string format_time(const std::optional<std::chrono::system_clock::time_point>& time) {
  if (!time) return "-";
  const std::time_t seconds = std::chrono::system_clock::to_time_t(*time);
  std::tm local{};
  localtime_r(&seconds, &local);
  return format_calendar("%Y-%m-%d %H:%M:%S", local);
}

std::string format_fixed(double value) { return format("%.2f", value); }

LiveLine::LiveLine(int descriptor)
    : descriptor_(descriptor), is_terminal_(isatty(descriptor) == 1) {}

void LiveLine::show(const std::string& text) {
  if (!is_terminal_) return;
  std::string line = printable(text);
  line.resize(std::min(line.size(), columns(descriptor_) - 1));
  write("\r" + line + "\x1b[K");
  shown_ = true;
}

void LiveLine::clear() {
  if (shown_) write("\r\x1b[K");
  shown_ = false;
}

void LiveLine::say(const std::string& text) {
  clear();
  write(printable(text) + "\n");
}

void LiveLine::write(const std::string& text) const {
  // Losing the terminal is not an error.
  [[maybe_unused]] const auto written = ::write(descriptor_, text.data(), text.size());
}

void ProgressLine::show(const std::string& label, double fraction, const std::string& text) {
  const double share = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) : 0;
  const auto full = static_cast<std::size_t>(std::lround(share * kBarCells));
  line_.show(label + " [" + std::string(full, '#') + std::string(kBarCells - full, '-') + "]" +
             format(" %3.0f%%", 100 * share) + "  " + text);
}

}  // namespace hydroprint::cli
