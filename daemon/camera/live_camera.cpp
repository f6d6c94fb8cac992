#include "daemon/camera/live_camera.h"

#include <poll.h>
#include <sys/eventfd.h>

#include <utility>
#include <vector>

#include "daemon/platform/log.h"
#include "daemon/platform/resource_names.h"
#include "sim/base/checked_json.h"
#include "sim/base/utf8.h"

namespace hydroprint::daemon {
namespace {

using LiveClock = std::chrono::steady_clock;

constexpr std::chrono::seconds kExpiry{10};  // how long after a request a client counts as watching
constexpr std::chrono::seconds kFresh{3};
constexpr std::chrono::seconds kPictureTimeout{5};
constexpr std::chrono::seconds kReopenAfter{3};
constexpr std::chrono::seconds kReleaseTimeout{5};
constexpr std::chrono::milliseconds kPollInterval{50};
constexpr int kMaxWaiting = 16;
constexpr int kBusyPoll_ms = 200;
constexpr int kIdlePoll_ms = 5000;

/// Parses a picture; nullopt if it is malformed.
std::optional<LivePicture> read_picture(const FramedMessage& framed_message, std::int64_t now_ms) {
  const auto parsed = parse_json(framed_message.head);
  if (!parsed) return {};
  const nlohmann::json& head = *parsed;
  try {
    LivePicture out;
    out.png = framed_message.bytes;
    out.width = head.at("width").get<int>();
    out.height = head.at("height").get<int>();
    out.nearest_mm = head.at("nearest_mm").get<double>();
    out.farthest_mm = head.at("farthest_mm").get<double>();
    out.measured_share = head.at("measured_share").get<double>();
    out.camera = one_line(head.at("camera").get<std::string>());
    out.time_ms = now_ms;
    return out;
  } catch (const nlohmann::json::exception&) {
    return {};
  }
}

/// Counts a waiting caller while this object exists.
class Waiting {
 public:
  explicit Waiting(int& count) : count_(count) { ++count_; }
  ~Waiting() { --count_; }
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;

 private:
  int& count_;
};

}  // namespace

LiveCamera::LiveCamera(CameraConfig camera, Layout layout, Clock clock)
    : camera_(std::move(camera)), layout_(std::move(layout)), clock_(std::move(clock)) {}

Result<std::unique_ptr<LiveCamera>> LiveCamera::make(CameraConfig camera, Layout layout,
                                                     Clock clock) {
  std::unique_ptr<LiveCamera> live_camera(
      new LiveCamera(std::move(camera), std::move(layout), std::move(clock)));
  live_camera->wake_ = UniqueFd(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!live_camera->wake_.valid()) return system_failure("eventfd", "cannot be created");
  live_camera->thread_ = std::thread([&live = *live_camera] { live.work(); });
  return live_camera;
}

LiveCamera::~LiveCamera() { stop(); }

void LiveCamera::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake();
  if (thread_.joinable()) thread_.join();
}

void LiveCamera::wake() {
  ::eventfd_write(wake_.get(), 1);
  change_.notify_all();
}

Result<LivePicture> LiveCamera::recent_picture(const std::function<bool()>& gone) {
  HP_RETURN_IF_ERROR(check_camera(camera_));
  std::unique_lock lock(mutex_);
  const Time start = LiveClock::now();
  if (start >= wanted_until_) failure_.reset();  // it may be left from earlier viewers
  wanted_until_ = start + kExpiry;
  wake();
  if (waiting_ >= kMaxWaiting) {
    return fail(Code::kResourceExhausted, "too many requests wait for the camera; try again later",
                ErrorReason::WATCHES_FULL);
  }
  const Waiting waiting(waiting_);
  for (Time now = start; now < start + kPictureTimeout; now = LiveClock::now()) {
    if (auto answer = available_answer(now)) return std::move(*answer);
    change_.wait_for(lock, kPollInterval);
    if (gone()) return fail(Code::kCancelled, "the client disconnected");
  }
  return fail(Code::kUnavailable,
              "no picture arrived within 5 s; the camera may still be starting, so try again",
              ErrorReason::CAMERA_STALLED);
}

/// Returns the response that is available immediately, if any.
std::optional<Result<LivePicture>> LiveCamera::available_answer(Time now) const {
  if (stopping_) {
    return fail(Code::kUnavailable, "the daemon is shutting down; try again after it has restarted",
                ErrorReason::SHUTTING_DOWN);
  }
  if (reserved_for_ != 0) {
    const std::string job = job_name(reserved_for_);
    return tl::unexpected(Error{Code::kAborted,
                                job + " is using the camera; try again when the job has ended",
                                ErrorReason::CAMERA_BUSY,
                                {{"job", job}}});
  }
  if (picture_ && now < picture_time_ + kFresh) return *picture_;
  if (failure_) return tl::unexpected(*failure_);
  return {};
}

std::int64_t LiveCamera::latest_ms() const {
  const std::lock_guard lock(mutex_);
  return picture_ ? picture_->time_ms : 0;
}

LiveCamera::Reservation LiveCamera::reserve(std::int64_t job) {
  {
    const std::lock_guard lock(mutex_);
    reserved_for_ = job;
  }
  wake();
  return Reservation(this);
}

void LiveCamera::wait_until_free() {
  std::unique_lock lock(mutex_);
  change_.wait_for(lock, kReleaseTimeout, [this] { return !process_ || stopping_; });
}

void LiveCamera::release() {
  {
    const std::lock_guard lock(mutex_);
    reserved_for_ = 0;
    failure_.reset();
  }
  wake();
}

void LiveCamera::work() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    step(LiveClock::now());
    wait(lock);
  }
  const std::unique_ptr<CameraProcess> last = std::move(process_);
  lock.unlock();
  change_.notify_all();
}

/// Waits until there may be work.
void LiveCamera::wait(std::unique_lock<std::mutex>& lock) {
  std::vector<pollfd> fds{{wake_.get(), POLLIN, 0}};
  if (process_) {
    for (const int fd : process_->descriptors()) fds.push_back({fd, POLLIN, 0});
  }
  const bool is_busy = process_ || LiveClock::now() < wanted_until_;
  lock.unlock();
  ::poll(fds.data(), fds.size(), is_busy ? kBusyPoll_ms : kIdlePoll_ms);
  eventfd_t wakeups = 0;
  ::eventfd_read(wake_.get(), &wakeups);
  lock.lock();
}

void LiveCamera::step(Time now) {
  const bool is_wanted = reserved_for_ == 0 && now < wanted_until_;
  if (!process_) {
    if (is_wanted && now >= retry_time_) begin(now);
    return;
  }
  for (const FramedMessage& framed_message : process_->read(now)) show(framed_message, now);
  if (!is_wanted) process_->ask_to_end(now);
  if (!process_->has_ended(now)) return;
  if (auto why = process_->failure()) fail_for_now(std::move(*why), now);
  process_ = nullptr;
  log(LogLevel::kDebug, "live_camera_ended", {});
  change_.notify_all();
}

void LiveCamera::begin(Time now) {
  auto started = CameraProcess::start(camera_, layout_);
  if (!started) return fail_for_now(std::move(started.error()), now);
  process_ = std::move(*started);
  log(LogLevel::kDebug, "live_camera_started", {});
}

void LiveCamera::show(const FramedMessage& framed_message, Time now) {
  auto picture = read_picture(framed_message, clock_());
  if (!picture) return;
  picture_ = std::move(picture);
  picture_time_ = now;
  failure_.reset();
  change_.notify_all();
}

void LiveCamera::fail_for_now(Error error, Time now) {
  log(LogLevel::kWarning, "live_camera_failed",
      {{"reason", name_of(error.reason)}, {"message", error.message}});
  failure_ = std::move(error);
  retry_time_ = now + kReopenAfter;
  change_.notify_all();
}

}  // namespace hydroprint::daemon
