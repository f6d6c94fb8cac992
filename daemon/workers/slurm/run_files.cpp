#include "daemon/workers/slurm/run_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>

#include "daemon/platform/durable_file.h"
#include "daemon/workers/worker_outcome.h"

namespace hydroprint::daemon::slurm {
namespace {

constexpr std::int64_t kTail = 16 << 10;
constexpr std::int64_t kReadAtOnce = 1 << 20;

// Reads from an offset; empty if there is no such file, or it has no bytes there. The worker can
// make anything of its files, also a pipe that nobody writes to.
std::string read_from(const std::filesystem::path& path, std::int64_t offset, std::int64_t most) {
  const auto file = open_file(path, O_RDONLY | O_NONBLOCK);
  struct stat info {};
  if (!file || ::fstat(file->get(), &info) != 0 || !S_ISREG(info.st_mode)) return {};
  const std::int64_t there = std::clamp<std::int64_t>(info.st_size - offset, 0, most);
  std::string out(static_cast<std::size_t>(there), '\0');
  const ssize_t count = ::pread(file->get(), out.data(), out.size(), offset);
  out.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  return out;
}

std::string tail_of(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = static_cast<std::int64_t>(std::filesystem::file_size(path, error));
  return error ? "" : read_from(path, std::max<std::int64_t>(0, size - kTail), kTail);
}

constexpr int exited(int status) { return status << 8; }  // as from waitpid()

}  // namespace

std::filesystem::path progress_file(const RunFolder& folder) { return folder.work() / "progress"; }

std::filesystem::path script_file(const RunFolder& folder) { return folder.root / "script"; }

bool has_begun(const RunFolder& folder) {
  std::error_code ignored;
  return std::filesystem::exists(folder.root / "begun", ignored);
}

std::optional<int> wait_status(const RunFolder& folder) {
  constexpr int kFirstSignal = 128, kLastSignal = 64, kCancelled = 130;
  const std::string text = read_from(folder.root / "exit", 0, 8);
  int status = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), status);
  if (error != std::errc() || end == text.data() + text.size() || *end != '\n') return std::nullopt;
  if (status < 0 || status > 255) return std::nullopt;
  const int signal = status - kFirstSignal;
  return status != kCancelled && signal > 0 && signal <= kLastSignal ? signal : exited(status);
}

std::string answer_of(const RunFolder& folder) { return tail_of(folder.root / "answer"); }

std::string errors_of(const RunFolder& folder) { return tail_of(folder.root / "errors"); }

std::vector<std::string> ProgressReader::lines(const RunFolder& folder) {
  const std::string more = read_from(progress_file(folder), read_, kReadAtOnce);
  read_ += static_cast<std::int64_t>(more.size());
  received_ += more;
  return take_progress_lines(received_);
}

}  // namespace hydroprint::daemon::slurm
