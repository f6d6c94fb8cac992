#include "sim/base/process/progress_sinks.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

namespace hydroprint::worker {
namespace {

constexpr int kBarLength = 24;

double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

std::string time_left(double eta_s) {
  const long seconds = std::lround(eta_s);
  if (seconds < 100) return fmt::format("{} s left", seconds);
  return fmt::format("{} min left", (seconds + 30) / 60);
}

}  // namespace

void ProgressPipe::write(const ProgressReport& report) {
  if (fd_ < 0) return;
  nlohmann::ordered_json line = {{"stage", report.stage},
                                 {"fraction", rounded(report.fraction, 1e4)},
                                 {"total_fraction", rounded(report.total_fraction, 1e4)},
                                 {"eta_s", nullptr}};
  if (report.eta_s) line["eta_s"] = rounded(*report.eta_s, 10);
  // A line is shorter than PIPE_BUF, so if poll() reports space, one write sends all of it without
  // blocking.
  const std::string text = line.dump() + "\n";
  pollfd ready{fd_, POLLOUT, 0};
  if (::poll(&ready, 1, 0) != 1) return;
  const bool gone = (ready.revents & POLLOUT) == 0;
  if (gone || (::write(fd_, text.data(), text.size()) < 0 && errno != EINTR && errno != EAGAIN)) {
    fd_ = -1;
  }
}

ProgressLine::ProgressLine(int fd) : fd_(::isatty(fd) == 1 ? fd : -1) {}

ProgressLine::~ProgressLine() {
  if (fd_ >= 0) ::dprintf(fd_, "\r\x1b[K");
}

void ProgressLine::show(const ProgressReport& report) const {
  if (fd_ < 0) return;
  std::string bar(static_cast<std::size_t>(kBarLength), '-');
  std::fill_n(bar.begin(), static_cast<int>(report.total_fraction * kBarLength), '#');
  ::dprintf(fd_, "\r\x1b[K[%s] %3.0f %%  %.40s  %s", bar.c_str(), 100 * report.total_fraction,
            report.stage.c_str(), report.eta_s ? time_left(*report.eta_s).c_str() : "");
}

}  // namespace hydroprint::worker
