#include "sim/base/process/progress_sinks.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <system_error>

namespace hydroprint::worker {
namespace {

constexpr int kBarLength = 24;
// O_NONBLOCK: a named pipe without a reader must not stop the program. Files ignore it.
constexpr int kAppend = O_WRONLY | O_APPEND | O_CLOEXEC | O_NONBLOCK;

double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

std::string time_left(double eta_s) {
  const long seconds = std::lround(eta_s);
  if (seconds < 100) return fmt::format("{} s left", seconds);
  return fmt::format("{} min left", (seconds + 30) / 60);
}

std::string json_line(const ProgressReport& report) {
  nlohmann::ordered_json line = {{"stage", report.stage},
                                 {"fraction", rounded(report.fraction, 1e4)},
                                 {"total_fraction", rounded(report.total_fraction, 1e4)},
                                 {"eta_s", nullptr}};
  if (report.eta_s) line["eta_s"] = rounded(*report.eta_s, 10);
  return line.dump() + "\n";
}

/// Appends lines with one write. Removes the beginning of a line for which the disk had no space.
void append_lines(int fd, std::string_view lines) {
  const off_t end = ::lseek(fd, 0, SEEK_END);
  const ssize_t written = ::write(fd, lines.data(), lines.size());
  if (written <= 0 || static_cast<std::size_t>(written) == lines.size()) return;
  const std::size_t cut = lines.substr(0, static_cast<std::size_t>(written)).rfind('\n') + 1;
  if (::ftruncate(fd, end + static_cast<off_t>(cut)) != 0) return;
}

}  // namespace

void ProgressPipe::write(const ProgressReport& report) {
  if (fd_ < 0) return;
  // A line is shorter than PIPE_BUF, so if poll() reports space, one write sends all of it without
  // blocking.
  const std::string text = json_line(report);
  pollfd ready{fd_, POLLOUT, 0};
  if (::poll(&ready, 1, 0) != 1) return;
  const bool gone = (ready.revents & POLLOUT) == 0;
  if (gone || (::write(fd_, text.data(), text.size()) < 0 && errno != EINTR && errno != EAGAIN)) {
    fd_ = -1;
  }
}

Status ProgressFile::create(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), kAppend | O_CREAT, 0666);
  if (fd < 0) {
    const std::string reason = std::generic_category().message(errno);
    return fail(Code::kInvalidArgument,
                path.string() + ": cannot be created (" + reason + "). Name another file");
  }
  ::close(fd);
  return {};
}

void ProgressFile::write(const ProgressReport& report) {
  if (path_.empty()) return;
  const std::string line = json_line(report);
  const std::lock_guard lock(mutex_);
  pending_ += line;
}

void ProgressFile::append() {
  std::string lines;
  {
    const std::lock_guard lock(mutex_);
    lines.swap(pending_);
  }
  if (lines.empty()) {
    if (last_.empty() || ++idle_calls_ < kRepeatAfter) return;
    lines = last_;
  }
  idle_calls_ = 0;
  last_ = lines.substr(lines.rfind('\n', lines.size() - 2) + 1);
  // Opened for each append, because NFS sends the bytes to its server when the file is closed.
  const int fd = ::open(path_.c_str(), kAppend);
  if (fd < 0) return;
  append_lines(fd, lines);
  ::close(fd);
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
