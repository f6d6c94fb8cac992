#include "hardware/rig/link_monitor.h"

#include <algorithm>
#include <cmath>

#include "hardware/rig/config.h"

namespace hydroprint::rig {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kFirstPause{50};
constexpr std::chrono::milliseconds kLongestPause{2000};
// Speeds up to this count as standstill, because encoder values fluctuate.
constexpr double kRest_mm_per_s = 0.2;

bool is_stale(TimePoint clean) {
  return std::chrono::duration<double>(Clock::now() - clean).count() >= kStale_s;
}

}  // namespace

Bits bits_of(const drive::DriveState& axis) {
  return {.moving = axis.moving || std::abs(axis.velocity_mm_per_s) > kRest_mm_per_s,
          .enabled = axis.enabled,
          .homed = axis.homed,
          .alarm = axis.alarm,
          .button = axis.stop_input,
          .limit = axis.positive_end || axis.negative_end};
}

Status LinkMonitor::connect() {
  HP_ASSIGN_OR_RETURN(const drive::Inspection found, drive_.connect());
  ++connects_;
  inspect_ = false;
  fresh_ = true;
  safe_ = !found.unsafe;
  trouble_ = found.unsafe;
  watchdog_s_ = found.watchdog_s;
  return {};
}

LinkMonitor::Look LinkMonitor::look() {
  if (!up_ && Clock::now() < next_try_) return {};
  if (inspect_ || !drive_.connected()) {
    if (Status done = connect(); !done) return miss(std::move(done).error());
  }
  const auto stale =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(kStale_s));
  auto axis = drive_.poll(up_ ? clean_ + stale : TimePoint::max());
  if (!axis) return miss(std::move(axis).error());
  const auto kind = fresh_ ? Event::Kind::kSeen : Event::Kind::kSample;
  up_ = true;
  fresh_ = false;
  misses_ = 0;
  pause_ = {};
  clean_ = axis->time;
  if (safe_) trouble_.reset();
  return {Event{kind, bits_of(*axis), safe_}, std::move(*axis)};
}

void LinkMonitor::lose() {
  up_ = false;
  inspect_ = true;
  misses_ = 0;
  next_try_ = Clock::now();
}

void LinkMonitor::keep_silent(double silence_s) {
  next_try_ = Clock::now() +
              std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(silence_s));
}

LinkMonitor::Look LinkMonitor::miss(Error error) {
  ++missed_;
  ++misses_;
  trouble_ = std::move(error);
  if (up_) {
    if (misses_ < kMissedPolls && !is_stale(clean_)) return {};
    lose();
    return {Event{Event::Kind::kLost}, {}};
  }
  pause_ = std::clamp(2 * pause_, kFirstPause, kLongestPause);
  next_try_ = Clock::now() + pause_;
  return {};
}

}  // namespace hydroprint::rig
