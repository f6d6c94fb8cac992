#include "sim/worker/verbs/preview_requests.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

namespace hydroprint::worker {
namespace {

// The interval at which next() checks whether to end.
constexpr std::chrono::milliseconds kLook{100};
// Maximum number of lines that wait for next(). If more arrive, the oldest are dropped.
constexpr std::size_t kMostWaiting = 64;

}  // namespace

struct PreviewRequests::Shared {
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::string> lines;
  bool closed = false;
  std::atomic<bool> newer = false;  // true if `lines` is not empty

  void add(std::string line) {
    const std::lock_guard lock(mutex);
    if (lines.size() == kMostWaiting) lines.erase(lines.begin());
    lines.push_back(std::move(line));
    newer = true;
    changed.notify_all();
  }

  void close() {
    const std::lock_guard lock(mutex);
    closed = true;
    changed.notify_all();
  }
};

namespace {

/// Splits the input into lines.
class Lines {
 public:
  template <class Take>
  void feed(std::string_view bytes, const Take& take) {
    for (;;) {
      const std::size_t end = bytes.find('\n');
      append(bytes.substr(0, end));
      if (end == std::string_view::npos) return;
      take(is_too_long_ ? std::string() : std::exchange(line_, {}));
      line_.clear();
      is_too_long_ = false;
      bytes.remove_prefix(end + 1);
    }
  }

 private:
  void append(std::string_view part) {
    is_too_long_ = is_too_long_ || line_.size() + part.size() > PreviewRequests::kMostBytes;
    if (!is_too_long_) line_ += part;
  }

  std::string line_;
  bool is_too_long_ = false;
};

}  // namespace

PreviewRequests::PreviewRequests(int fd) : shared_(std::make_shared<Shared>()) {
  std::thread([shared = shared_, fd] {
    Lines lines;
    std::array<char, 4096> bytes{};
    for (;;) {
      const ssize_t got = ::read(fd, bytes.data(), bytes.size());
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return shared->close();
      lines.feed({bytes.data(), static_cast<std::size_t>(got)},
                 [&shared](std::string line) { shared->add(std::move(line)); });
    }
  }).detach();
}

std::optional<PreviewRequests::Next> PreviewRequests::next(const std::function<bool()>& ended) {
  std::unique_lock lock(shared_->mutex);
  while (shared_->lines.empty() && !shared_->closed && !ended()) {
    shared_->changed.wait_for(lock, kLook);
  }
  if (shared_->lines.empty() || ended()) return {};
  Next next;
  next.passed_over = std::exchange(shared_->lines, {});
  next.line = std::move(next.passed_over.back());
  next.passed_over.pop_back();
  shared_->newer = false;
  return next;
}

bool PreviewRequests::has_newer() const { return shared_->newer; }

}  // namespace hydroprint::worker
