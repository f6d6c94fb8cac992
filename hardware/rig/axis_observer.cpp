#include "hardware/rig/axis_observer.h"

#include <algorithm>

namespace hydroprint::rig {
namespace {

// Shortest time between samples that are kept; with faster polls, the latest sample is replaced.
constexpr double kSpacing_s = 0.015;
constexpr std::size_t kMost = 1 + static_cast<std::size_t>(kObserved_s / kSpacing_s) + 1;

AxisSample sample_of(const drive::DriveState& axis) {
  return {axis.time, axis.time_error.count(), axis.position_mm, axis.velocity_mm_per_s};
}

}  // namespace

AxisObserver::AxisObserver(const RigConfig& config, const drive::DriveProfile& profile)
    : config_(config), profile_(profile) {
  samples_.reserve(kMost);
}

void AxisObserver::add(const drive::DriveState& axis) {
  const std::size_t n = samples_.size();
  if (n >= 2 && seconds(samples_[n - 2].time, axis.time) < kSpacing_s) samples_.pop_back();
  const auto is_old = [&](const AxisSample& s) { return seconds(s.time, axis.time) > kObserved_s; };
  samples_.erase(samples_.begin(), std::find_if_not(samples_.begin(), samples_.end(), is_old));
  if (samples_.size() == kMost) samples_.erase(samples_.begin());
  samples_.push_back(sample_of(axis));
}

/// Notes where and when a state begins. Homing sets the position to zero, and without torque the
/// axis may be moved by hand; earlier samples say nothing then.
void AxisObserver::enter(const Condition& condition, const drive::DriveState& axis) {
  const bool homes = condition.motion == Motion::kHome;
  const bool has_homed = before_.motion == Motion::kHome && !homes;
  if (has_homed || condition.state == State::kDisarmed) forget();
  order_ = {.state = condition.state, .since = axis.time, .from_mm = axis.position_mm};
}

std::optional<Cause> AxisObserver::look(const Condition& condition,
                                        const MotionSupervisor* supervisor,
                                        const drive::DriveState& axis,
                                        std::optional<TimePoint> stopped) {
  if (condition.state != before_.state || condition.motion != before_.motion) {
    enter(condition, axis);
  }
  before_ = condition;
  add(axis);
  order_.stopped = stopped;
  if (condition.link == Link::kNone) return std::nullopt;
  const bool supervised = supervisor != nullptr && in_motion(condition.state);
  return observe(config_, profile_, supervised ? supervisor->order() : order_, samples_);
}

void AxisObserver::forget() { samples_.clear(); }

}  // namespace hydroprint::rig
