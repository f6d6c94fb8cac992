#include "client/cli/terminal/console.h"

#include <fmt/chrono.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "sim/base/utf8.h"

namespace hydroprint::cli {
namespace {

constexpr int kBarCells = 24;

std::size_t columns(int descriptor) {
  winsize size{};
  if (ioctl(descriptor, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

}  // namespace

std::string printable(std::string_view text) { return one_line(std::string(text)); }

std::string format_time(const std::optional<std::chrono::system_clock::time_point>& time) {
  if (!time) return "-";
  const std::time_t seconds = std::chrono::system_clock::to_time_t(*time);
  return fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::localtime(seconds));
}

std::string format_fixed(double value) { return fmt::format("{:.2f}", value); }

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
  line_.show(fmt::format("{} [{:-<{}}] {:3.0f}%  {}", label, std::string(full, '#'), kBarCells,
                         100 * share, text));
}

}  // namespace hydroprint::cli
