#include "hardware/rig/stop_channel.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "hardware/rig/config.h"
#include "sim/base/process/real_time_thread.h"

namespace hydroprint::rig {
namespace {

constexpr int kTick_ms = 10;
// Greater than that of the control loop, which may hang.
constexpr int kStopPriority = 11;

}  // namespace

StopChannel::StopChannel(const drive::Drive& drive)
    : line_(drive),
      wake_event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      thread_([this] { run(); }) {}

StopChannel::~StopChannel() {
  end_ = true;
  ring();
  thread_.join();
  ::close(wake_event_);
}

void StopChannel::ring() noexcept {
  const std::uint64_t one = 1;
  // The write fails only if the counter is full, and then the thread is awake anyway.
  if (::write(wake_event_, &one, sizeof one) < 0) return;
}

void StopChannel::stop() noexcept {
  stop_ = true;
  ring();
}

void StopChannel::prepare() noexcept {
  prepare_ = true;
  ring();
}

void StopChannel::watch(bool in_motion, TimePoint clean) noexcept {
  clean_ = clean.time_since_epoch().count();
  if (in_motion_.exchange(in_motion) != in_motion) ring();
}

bool StopChannel::owner_is_late() const {
  if (!in_motion_) return false;
  const TimePoint clean{TimePoint::duration(clean_)};
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - clean).count() > kStale_s;
}

void StopChannel::keep_silent(std::chrono::duration<double> silence) noexcept {
  const auto until = std::chrono::steady_clock::now() + silence;
  silent_until_ =
      std::chrono::time_point_cast<TimePoint::duration>(until).time_since_epoch().count();
}

void StopChannel::send_stop() {
  const auto now = [] { return std::chrono::steady_clock::now().time_since_epoch().count(); };
  if (now() < silent_until_) return;
  if (line_.stop(kPatience)) acknowledged_ = now();
}

void StopChannel::run() {
  // The system grants the same to the control loop, which reports it.
  (void)become_real_time(kStopPriority);
  (void)lock_memory(this, sizeof *this);
  while (!end_ || stop_) {
    pollfd wake{wake_event_, POLLIN, 0};
    ::poll(&wake, 1, in_motion_ ? kTick_ms : -1);
    std::uint64_t wakeups = 0;
    if (::read(wake_event_, &wakeups, sizeof wakeups) < 0) wakeups = 0;
    if (owner_is_late()) {
      in_motion_ = false;  // stops only once
      tripped_ = true;
      stop_ = true;
    }
    // Errors are ignored: the control loop sees whether the drive stopped when it polls.
    stopping_ = true;
    if (stop_.exchange(false)) send_stop();
    stopping_ = false;
    if (prepare_.exchange(false)) (void)line_.connect();
  }
}

}  // namespace hydroprint::rig
