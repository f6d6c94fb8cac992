#include "daemon/admin/progress_meter.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "sim/base/number_text.h"

namespace hydroprint::admin {

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
  std::cerr << fmt::format("{}{}: {} % of {}, {} left{}", is_terminal_ ? "\r\x1b[K" : "", what_,
                           static_cast<int>(100 * share), format_bytes(total_bytes_),
                           format_duration(std::chrono::seconds(left_s)), is_terminal_ ? "" : "\n")
            << std::flush;
  is_line_open_ = is_terminal_;
}

}  // namespace hydroprint::admin
