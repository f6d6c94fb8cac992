#include "daemon/workers/preview_pool.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/platform/log.h"
#include "daemon/workers/worker_outcome.h"
#include "sim/base/checked_json.h"

namespace hydroprint::daemon {
namespace {

using SteadyClock = std::chrono::steady_clock;

// Limited because each slot keeps a mesh in memory.
constexpr std::size_t kMaxSlots = 4;
constexpr std::chrono::seconds kKept{120};
constexpr std::chrono::seconds kTimeLimit{30};
constexpr std::chrono::milliseconds kLook{50};
constexpr int kLookAgain_ms = 500;

tl::unexpected<Error> shutting_down() {
  return fail(Code::kUnavailable, "the daemon is shutting down; try again after it has restarted",
              ErrorReason::SHUTTING_DOWN);
}

/// Returns a worker's response, or the error in it; nullopt if it belongs to a request with another
/// id.
std::optional<Result<PreviewFrame>> answer_to(std::int64_t id, PreviewFrame frame) {
  const auto head = parse_json(frame.head).value_or(nullptr);
  if (json_unsigned(head, "id") != static_cast<std::uint64_t>(id)) return {};
  const auto& error = json_at(head, "error");
  if (error.is_null()) return frame;
  Error refused = read_failure(error).value_or(
      Error{{}, "the worker refused the request without a readable reason"});
  refused.code = Code::kInvalidArgument;
  if (refused.reason != ErrorReason::INPUT_REFUSED) refused.reason = ErrorReason::PREVIEW_REFUSED;
  if (!refused.field.empty()) refused.field.insert(0, "simulate.");
  return tl::unexpected(std::move(refused));
}

}  // namespace

struct PreviewPool::Call {
  std::int64_t id = 0;
  PreviewRequest ask;
  bool sent = false;
  SteadyTime deadline;
  std::optional<Result<PreviewFrame>> result;
};

struct PreviewPool::Slot {
  std::unique_ptr<PreviewWorker> worker;
  std::shared_ptr<Call> call;  // the waiting call, if any
  SteadyTime used;
};

Result<std::unique_ptr<PreviewPool>> PreviewPool::make(PreviewOptions options,
                                                       const Layout& layout) {
  std::unique_ptr<PreviewPool> preview_pool(new PreviewPool(std::move(options), layout));
  preview_pool->wake_ = UniqueFd(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!preview_pool->wake_.valid()) return system_failure("eventfd", "cannot be created");
  preview_pool->thread_ = std::thread([&pool = *preview_pool] { pool.work(); });
  return preview_pool;
}

PreviewPool::PreviewPool(PreviewOptions options, Layout layout)
    : options_(std::move(options)), layout_(std::move(layout)) {}

PreviewPool::~PreviewPool() { stop(); }

void PreviewPool::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  ::eventfd_write(wake_.get(), 1);
  if (thread_.joinable()) thread_.join();
}

Result<PreviewFrame> PreviewPool::compute(const std::string& owner, const PreviewRequest& ask,
                                          const std::function<bool()>& gone) {
  std::unique_lock lock(mutex_);
  HP_ASSIGN_OR_RETURN(const std::shared_ptr<Call> call, place(owner, ask));
  ::eventfd_write(wake_.get(), 1);
  while (!call->result) {
    answered_.wait_for(lock, kLook);
    if (call->result || !gone()) continue;
    const auto slot = slots_.find(owner);
    if (slot != slots_.end() && slot->second->call == call) slot->second->call = nullptr;
    return fail(Code::kCancelled, "the client disconnected");
  }
  return std::move(*call->result);
}

/// Assigns a slot to the owner and ends the owner's previous call.
Result<std::shared_ptr<PreviewPool::Call>> PreviewPool::place(const std::string& owner,
                                                              const PreviewRequest& ask) {
  if (stopping_) return shutting_down();
  if (!slots_.contains(owner) && !make_room()) {
    return fail(Code::kResourceExhausted, "too many previews are open; try again in a moment",
                ErrorReason::PREVIEWS_FULL);
  }
  std::unique_ptr<Slot>& slot = slots_[owner];
  if (!slot) slot = std::make_unique<Slot>();
  if (slot->call) {
    finish(*slot, fail(Code::kAborted, "superseded by a newer preview request",
                       ErrorReason::PREVIEW_SUPERSEDED));
  }
  const auto now = SteadyClock::now();
  slot->used = now;
  slot->call = std::make_shared<Call>(Call{++last_id_, ask, false, now + kTimeLimit, {}});
  return slot->call;
}

/// If all slots are in use, frees the least recently used slot without a waiting call. Returns
/// false if every slot has one.
bool PreviewPool::make_room() {
  if (slots_.size() < kMaxSlots) return true;
  auto oldest = slots_.end();
  for (auto slot = slots_.begin(); slot != slots_.end(); ++slot) {
    if (slot->second->call || (oldest != slots_.end() && oldest->second->used < slot->second->used))
      continue;
    oldest = slot;
  }
  if (oldest == slots_.end()) return false;
  slots_.erase(oldest);
  return true;
}

void PreviewPool::work() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    const auto now = SteadyClock::now();
    for (const auto& [owner, slot] : slots_) serve(*slot, now);
    std::erase_if(slots_, [&](const auto& entry) {
      return !entry.second->call && now - entry.second->used > kKept;
    });
    wait(lock);
  }
  for (const auto& [owner, slot] : slots_) {
    if (slot->call) finish(*slot, shutting_down());
  }
  slots_.clear();
}

/// Waits until there may be work.
void PreviewPool::wait(std::unique_lock<std::mutex>& lock) {
  std::vector<pollfd> fds{{wake_.get(), POLLIN, 0}};
  for (const auto& [owner, slot] : slots_) {
    if (slot->worker) fds.push_back({slot->worker->answers_fd(), POLLIN, 0});
  }
  lock.unlock();
  ::poll(fds.data(), fds.size(), kLookAgain_ms);
  eventfd_t wakeups = 0;
  ::eventfd_read(wake_.get(), &wakeups);
  lock.lock();
}

void PreviewPool::serve(Slot& slot, SteadyTime now) {
  if (slot.call && !slot.call->sent) begin(slot);
  if (!slot.worker) return;
  for (PreviewFrame& frame : slot.worker->read()) take(slot, std::move(frame));
  if (const auto& failure = slot.worker->failure()) {
    if (slot.call) finish(slot, tl::unexpected(*failure));
    slot.worker = nullptr;
  } else if (slot.call && now > slot.call->deadline) {
    finish(slot, fail(Code::kResourceExhausted,
                      "it took longer than 30 s; simplify the mesh, or submit a job instead",
                      ErrorReason::TIME_LIMIT));
    slot.worker = nullptr;
  }
}

/// Sends the call to the slot's worker; starts a new worker first if the mesh is different.
void PreviewPool::begin(Slot& slot) {
  Call& call = *slot.call;
  call.sent = true;
  if (!slot.worker || slot.worker->key() != call.ask.key) {
    slot.worker = nullptr;
    auto started =
        PreviewWorker::start(call.ask, call.id, options_.program, options_.confine_program,
                             options_.limits, options_.threads, layout_);
    if (!started) return finish(slot, tl::unexpected(started.error()));
    slot.worker = std::move(*started);
    log(LogLevel::kDebug, "preview_worker_started", {{"preview", call.id}});
  }
  slot.worker->ask(call.id, call.ask.dip);
}

void PreviewPool::take(Slot& slot, PreviewFrame frame) {
  if (!slot.call) return;
  auto answer = answer_to(slot.call->id, std::move(frame));
  if (!answer) return;  // answer to a call that has ended
  slot.used = SteadyClock::now();
  finish(slot, std::move(*answer));
}

void PreviewPool::finish(Slot& slot, Result<PreviewFrame> result) {
  slot.call->result = std::move(result);
  slot.call = nullptr;
  answered_.notify_all();
}

}  // namespace hydroprint::daemon
