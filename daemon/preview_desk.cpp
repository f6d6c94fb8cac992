#include "daemon/preview_desk.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/log.h"

namespace hydroprint::daemon {
namespace {

using SteadyClock = std::chrono::steady_clock;

// Each has a mesh in memory.
constexpr std::size_t kMostSeats = 4;
constexpr std::chrono::seconds kKept{120};
constexpr std::chrono::seconds kTimeLimit{30};
constexpr std::chrono::milliseconds kLook{50};
constexpr int kLookAgain_ms = 500;

tl::unexpected<Error> shutting_down() {
  return fail(Code::kUnavailable, "the daemon is shutting down; try again when it is back",
              "SHUTTING_DOWN");
}

/// What a worker's answer says of a request, if it is one of that number.
std::optional<Result<PreviewFrame>> answer_to(std::int64_t id, PreviewFrame frame) {
  const auto head = nlohmann::json::parse(frame.head, nullptr, /*allow_exceptions=*/false);
  const auto told = head.find("id");
  if (told == head.end() || !told->is_number_integer() || *told != id) return {};
  const auto error = head.find("error");
  if (error == head.end()) return frame;
  const std::string message =
      error->is_object() && error->contains("message") && error->at("message").is_string()
          ? error->at("message").get<std::string>()
          : "the worker refused it without a word";
  return fail(Code::kInvalidArgument, message, "PREVIEW_REFUSED");
}

}  // namespace

struct PreviewDesk::Call {
  std::int64_t id = 0;
  PreviewAsk ask;
  bool sent = false;
  SteadyTime deadline;
  std::optional<Result<Previewed>> result;
};

struct PreviewDesk::Seat {
  std::unique_ptr<PreviewWorker> worker;
  std::shared_ptr<const PreviewFrame> mesh;  // once the worker told it
  std::shared_ptr<Call> call;                // the one that waits, if any
  SteadyTime used;
};

Result<std::unique_ptr<PreviewDesk>> PreviewDesk::make(PreviewOptions options,
                                                       const Layout& layout) {
  HP_ASSIGN_OR_RETURN(Sandbox sandbox, Sandbox::make());
  std::unique_ptr<PreviewDesk> made(
      new PreviewDesk(std::move(options), layout, std::move(sandbox)));
  made->wake_ = UniqueFd(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!made->wake_.valid()) return system_failure("eventfd", "cannot be made");
  made->thread_ = std::thread([&desk = *made] { desk.work(); });
  return made;
}

PreviewDesk::PreviewDesk(PreviewOptions options, Layout layout, Sandbox sandbox)
    : options_(std::move(options)), layout_(std::move(layout)), sandbox_(std::move(sandbox)) {}

PreviewDesk::~PreviewDesk() { stop(); }

void PreviewDesk::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  ::eventfd_write(wake_.get(), 1);
  if (thread_.joinable()) thread_.join();
}

Result<Previewed> PreviewDesk::compute(const std::string& owner, const PreviewAsk& ask,
                                       const std::function<bool()>& gone) {
  std::unique_lock lock(mutex_);
  HP_ASSIGN_OR_RETURN(const std::shared_ptr<Call> call, place(owner, ask));
  ::eventfd_write(wake_.get(), 1);
  while (!call->result) {
    answered_.wait_for(lock, kLook);
    if (call->result || !gone()) continue;
    const auto seat = seats_.find(owner);
    if (seat != seats_.end() && seat->second->call == call) seat->second->call = nullptr;
    return fail(Code::kCancelled, "the caller left");
  }
  return std::move(*call->result);
}

/// Gives the owner a seat, whose call before ends.
Result<std::shared_ptr<PreviewDesk::Call>> PreviewDesk::place(const std::string& owner,
                                                              const PreviewAsk& ask) {
  if (stopping_) return shutting_down();
  if (!seats_.contains(owner) && !make_room()) {
    return fail(Code::kResourceExhausted,
                "as many people as can be are shown previews; try again in a moment",
                "PREVIEWS_FULL");
  }
  std::unique_ptr<Seat>& seat = seats_[owner];
  if (!seat) seat = std::make_unique<Seat>();
  if (seat->call) {
    finish(*seat, fail(Code::kAborted, "a newer preview was asked for; this one is not wanted",
                       "PREVIEW_SUPERSEDED"));
  }
  const auto now = SteadyClock::now();
  seat->used = now;
  seat->call = std::make_shared<Call>(Call{++last_id_, ask, false, now + kTimeLimit, {}});
  return seat->call;
}

/// Frees the seat that was not used for longest, if all are taken and one waits for nothing.
bool PreviewDesk::make_room() {
  if (seats_.size() < kMostSeats) return true;
  auto oldest = seats_.end();
  for (auto seat = seats_.begin(); seat != seats_.end(); ++seat) {
    if (seat->second->call || (oldest != seats_.end() && oldest->second->used < seat->second->used))
      continue;
    oldest = seat;
  }
  if (oldest == seats_.end()) return false;
  seats_.erase(oldest);
  return true;
}

void PreviewDesk::work() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    const auto now = SteadyClock::now();
    for (const auto& [owner, seat] : seats_) serve(*seat, now);
    std::erase_if(seats_, [&](const auto& entry) {
      return !entry.second->call && now - entry.second->used > kKept;
    });
    wait(lock);
  }
  for (const auto& [owner, seat] : seats_) {
    if (seat->call) finish(*seat, shutting_down());
  }
  seats_.clear();
}

/// Waits until there may be something to do.
void PreviewDesk::wait(std::unique_lock<std::mutex>& lock) {
  std::vector<pollfd> fds{{wake_.get(), POLLIN, 0}};
  for (const auto& [owner, seat] : seats_) {
    if (seat->worker) fds.push_back({seat->worker->answers_fd(), POLLIN, 0});
  }
  lock.unlock();
  ::poll(fds.data(), fds.size(), kLookAgain_ms);
  eventfd_t rings = 0;
  ::eventfd_read(wake_.get(), &rings);
  lock.lock();
}

void PreviewDesk::serve(Seat& seat, SteadyTime now) {
  if (seat.call && !seat.call->sent) begin(seat);
  if (!seat.worker) return;
  for (PreviewFrame& frame : seat.worker->read()) take(seat, std::move(frame));
  if (const auto& failure = seat.worker->failure()) {
    if (seat.call) finish(seat, tl::unexpected(*failure));
    seat.worker = nullptr;
  } else if (seat.call && now > seat.call->deadline) {
    finish(seat, fail(Code::kResourceExhausted,
                      "the preview took longer than 30 s; simplify the mesh, or submit it as a job",
                      "TIME_LIMIT"));
    seat.worker = nullptr;
  }
}

/// Sends the call to the seat's worker, or to a new one if that has another mesh.
void PreviewDesk::begin(Seat& seat) {
  Call& call = *seat.call;
  call.sent = true;
  if (!seat.worker || seat.worker->key() != call.ask.key) {
    seat.mesh = nullptr;
    seat.worker = nullptr;
    auto started = PreviewWorker::start(call.ask, call.id, options_.program, options_.limits,
                                        options_.threads, sandbox_, layout_);
    if (!started) return finish(seat, tl::unexpected(started.error()));
    seat.worker = std::move(*started);
    log(LogLevel::kDebug, "preview_worker_started", {{"preview", call.id}});
  }
  seat.worker->ask(call.id, call.ask.dip);
}

void PreviewDesk::take(Seat& seat, PreviewFrame frame) {
  if (!seat.mesh) {
    seat.mesh = std::make_shared<const PreviewFrame>(std::move(frame));
    return;
  }
  if (!seat.call) return;
  auto answer = answer_to(seat.call->id, std::move(frame));
  if (!answer) return;  // of a call that has ended
  seat.used = SteadyClock::now();
  if (!*answer) return finish(seat, tl::unexpected(answer->error()));
  finish(seat, Previewed{seat.mesh, std::move(**answer)});
}

void PreviewDesk::finish(Seat& seat, Result<Previewed> result) {
  seat.call->result = std::move(result);
  seat.call = nullptr;
  answered_.notify_all();
}

}  // namespace hydroprint::daemon
