#include "daemon/admin/progress_meter.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace hydroprint::admin {

std::string bytes_text(std::int64_t bytes) {
  constexpr std::array kUnits{"B", "kB", "MB", "GB", "TB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 999.5 && unit + 1 < kUnits.size(); ++unit) value /= 1000;
  std::ostringstream out;
  out << std::fixed << std::setprecision(unit > 0 && value < 10 ? 1 : 0) << value << ' '
      << kUnits[unit];
  return out.str();
}

ProgressMeter::ProgressMeter(std::string what, std::int64_t total_bytes)
    : what_(std::move(what)),
      total_bytes_(total_bytes),
      is_terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressMeter::~ProgressMeter() {
  if (is_line_open_) std::cerr << std::endl;
}

void ProgressMeter::add(std::int64_t bytes) {
  done_bytes_ += bytes;
  const auto now = Clock::now();
  if (now - shown_ < (is_terminal_ ? std::chrono::milliseconds(200) : std::chrono::seconds(10))) {
    return;
  }
  shown_ = now;
  const double seconds = std::chrono::duration<double>(now - begun_).count();
  const double share =
      std::min(1.0, static_cast<double>(done_bytes_) /
                        static_cast<double>(std::max<std::int64_t>(total_bytes_, 1)));
  const auto left_s =
      static_cast<std::int64_t>(std::ceil(seconds * (1 - share) / std::max(share, 1e-6)));
  std::ostringstream line;
  line << what_ << ": " << static_cast<int>(100 * share) << " % of " << bytes_text(total_bytes_)
       << ", " << left_s / 60 << ':' << std::setw(2) << std::setfill('0') << left_s % 60 << " left";
  std::cerr << (is_terminal_ ? "\r\x1b[K" : "") << line.str() << (is_terminal_ ? "" : "\n")
            << std::flush;
  is_line_open_ = is_terminal_;
}

}  // namespace hydroprint::admin
