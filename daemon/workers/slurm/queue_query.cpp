#include "daemon/workers/slurm/queue_query.h"

#include <poll.h>

#include "daemon/platform/log.h"

namespace hydroprint::daemon::slurm {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr std::chrono::seconds kFirstAnswer{2};
constexpr int kFirstTick_ms = 50;

}  // namespace

void QueueQuery::step(bool is_wanted) {
  if (query_) {
    if (const auto end = query_->poll()) {
      query_.reset();
      take(*end);
    }
  } else if (is_wanted && SteadyClock::now() >= next_) {
    start();
  }
}

void QueueQuery::start() {
  began_ = SteadyClock::now();
  next_ = began_ + between_;
  auto query = CommandRun::start(queue_command(), folder_, patience_);
  if (query) {
    query_.emplace(*std::move(query));
  } else {
    take({.errors = query.error().message});
  }
}

void QueueQuery::take(const CommandEnd& end) {
  auto queue = end.status == 0 ? parse_queue(end.output) : std::nullopt;
  if (queue.has_value() == is_silent_) {
    is_silent_ = !queue.has_value();
    log(is_silent_ ? LogLevel::kWarning : LogLevel::kInfo,
        is_silent_ ? "cluster_silent" : "cluster_answers", {{"message", end.errors}});
  }
  if (queue) answer_ = Answer{*std::move(queue), began_};
}

void QueueQuery::wait_once() {
  if (has_waited_) return;
  has_waited_ = true;
  const auto deadline = SteadyClock::now() + kFirstAnswer;
  while (!answer_ && SteadyClock::now() < deadline) {
    step(true);
    std::vector<pollfd> fds;
    for (const int fd : descriptors()) fds.push_back({fd, POLLIN, 0});
    ::poll(fds.data(), fds.size(), kFirstTick_ms);
  }
}

std::vector<int> QueueQuery::descriptors() const {
  return query_ ? query_->descriptors() : std::vector<int>();
}

}  // namespace hydroprint::daemon::slurm
