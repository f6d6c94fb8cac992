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

constexpr std::int64_t kReadAtOnce = 1 << 20;

// Opens the folder first: a network file system then looks again for files that did not exist.
UniqueFd open_folder(const std::filesystem::path& path) {
  return UniqueFd(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
}

// Reads from an offset, or the last bytes if it is negative; empty if there is no such file, or it
// has no bytes there. The worker can make anything of its files, also a pipe that nobody writes to.
std::string read_from(const std::filesystem::path& path, std::int64_t offset, std::int64_t most) {
  const UniqueFd folder = open_folder(path.parent_path());
  const UniqueFd file(::openat(folder.get(), path.filename().c_str(),
                               O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC));
  struct stat info {};
  if (::fstat(file.get(), &info) != 0 || !S_ISREG(info.st_mode)) return {};
  if (offset < 0) offset = std::max<std::int64_t>(0, info.st_size - most);
  const std::int64_t there = std::clamp<std::int64_t>(info.st_size - offset, 0, most);
  std::string out(static_cast<std::size_t>(there), '\0');
  const ssize_t count = ::pread(file.get(), out.data(), out.size(), offset);
  out.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  return out;
}

std::string tail_of(const std::filesystem::path& path) {
  constexpr std::int64_t kTail = 16 << 10;
  return read_from(path, -1, kTail);
}

constexpr int exited(int status) { return status << 8; }  // as from waitpid()

}  // namespace

std::filesystem::path progress_file(const RunFolder& folder) { return folder.work() / "progress"; }

std::filesystem::path script_file(const RunFolder& folder) { return folder.root / "script"; }

bool has_begun(const RunFolder& folder) {
  const UniqueFd root = open_folder(folder.root);
  return ::faccessat(root.get(), "begun", F_OK, 0) == 0;
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
