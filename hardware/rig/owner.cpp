#include "hardware/rig/owner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include "hardware/rig/limits.h"

namespace hydroprint::rig {
namespace {

using Clock = std::chrono::steady_clock;
using Kind = Event::Kind;

constexpr double kPendingPatience_s = 2;
constexpr double kStopAgain_s = 0.2;
constexpr int kStillLooks = 2;
// Beyond its set time, before the watchdog of a drive has surely acted.
constexpr double kWatchdogMargin_s = 0.05;
// Beyond the computed time, before an axis that goes on after a stop counts as not obeying.
constexpr double kObeyMargin_s = 0.5;
// Beyond the computed one, before an axis that nobody sees counts as being at rest.
constexpr double kStandstillMargin_s = 0.5;

double seconds_since(TimePoint time) {
  return std::chrono::duration<double>(Clock::now() - time).count();
}

}  // namespace

Owner::Owner(const RigConfig& config, drive::Drive& drive, Stopper& stopper, Desk& desk)
    : config_(config),
      drive_(drive),
      stopper_(stopper),
      desk_(desk),
      lookout_(drive),
      log_(desk.board) {}

void Owner::run() {
  const auto period = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(config_.poll_period_s));
  TimePoint due = Clock::now();
  double squares = 0;
  while (!desk_.end) {
    std::this_thread::sleep_until(due);
    const double late_s = seconds_since(due);
    squares += late_s * late_s;
    ++jitter_.ticks;
    jitter_.largest_s = std::max(jitter_.largest_s, late_s);
    jitter_.rms_s = std::sqrt(squares / static_cast<double>(jitter_.ticks));
    tick();
    for (due += period; due < Clock::now(); due += period) ++jitter_.skipped;
  }
  shut_down();
}

void Owner::shut_down() {
  refuse_all();
  if (in_motion(condition_.state)) apply({Kind::kStop});
  const TimePoint begun = Clock::now();
  const double patience_s = stopping_time_s(config_, drive_.profile()) + 2 * kStandstillMargin_s;
  while (condition_.state == State::kStopping && seconds_since(begun) < patience_s) {
    std::this_thread::sleep_for(std::chrono::duration<double>(config_.poll_period_s));
    look();
    keep_going();
    publish();
  }
  stopper_.watch(false, lookout_.clean());
  if (lookout_.is_up()) (void)drive_.disable();  // else its watchdog stops it, and nobody moves it
  drive_.disconnect();
}

void Owner::tick() {
  take_stops();
  look();
  take_orders();
  keep_going();
  publish();
}

void Owner::take_stops() {
  if (stopper_.take_trip()) {  // it was this thread that did not look
    lookout_.lose();
    lose();
  }
  const std::uint64_t asked = desk_.stops;
  if (asked == stops_) return;
  stops_ = asked;
  apply({Kind::kStop});
}

/// At rest is what was seen twice after a stop, lest a motion begins that was sent before it.
Bits Owner::settled(Bits bits) {
  if (condition_.state != State::kStopping) return bits;
  still_ = bits.moving ? 0 : still_ + 1;
  bits.moving = still_ < kStillLooks;
  return bits;
}

void Owner::look() {
  auto seen = lookout_.look();
  if (seen.event && seen.event->kind == Kind::kLost) return lose();
  if (seen.axis) {
    axis_ = std::move(*seen.axis);
    seen.event->bits = settled(seen.event->bits);
    if (seen.event->kind == Kind::kSeen) {
      stopper_.prepare();
      stopping_since_ = Clock::now();  // if it is: from now on it can obey
    }
  }
  if (seen.event) apply(*seen.event);
  if (seen.axis) {
    follow(*axis_);
    record(*axis_);
    return;
  }
  const double unseen_s = seconds_since(lookout_.clean());
  if (condition_.state == State::kStopping && condition_.link == Link::kNone &&
      unseen_s > stopping_time_s(config_, drive_.profile()) + kStandstillMargin_s) {
    apply({Kind::kStandstillAssumed});
  }
}

/// A drive that may be moving and was perhaps not reached by the stop is left alone until its own
/// watchdog has stopped it: whatever it hears would keep it going.
void Owner::lose() {
  axis_.reset();
  apply({Kind::kLost});
  if (condition_.state != State::kStopping) return;
  const double patience_s = std::chrono::duration<double>(Stopper::kPatience).count();
  lookout_.keep_silent(patience_s + lookout_.watchdog_s() + kWatchdogMargin_s);
}

void Owner::follow(const drive::DriveState& axis) {
  if (!course_) return;
  const Course::Advice advice = course_->look(axis);
  if (advice.next && !command_leg(*advice.next)) apply({Kind::kFollowingError});
  if (advice.event) apply({*advice.event});
}

void Owner::record(const drive::DriveState& axis) {
  Sample sample;
  sample.time = axis.time;
  sample.time_error_s = axis.time_error.count();
  sample.position_mm = axis.position_mm;
  sample.velocity_mm_per_s = axis.velocity_mm_per_s;
  sample.expected_mm = std::numeric_limits<double>::quiet_NaN();
  sample.motion = log_.current();
  sample.state = condition_.state;
  if (course_) course_->note(sample);
  sample.number = desk_.board.samples.add(sample);
  log_.see(sample, condition_.state != State::kStopping && !bits_of(axis).moving);
}

Step Owner::apply(const Event& event) {
  const Condition before = condition_;
  const Step taken = step(before, event);
  condition_ = taken.next;
  note_change(before);
  if (!act(taken.actions) && condition_.pending != Pending::kNone) apply({Kind::kTimedOut});
  answer_waiting();
  return taken;
}

void Owner::note_change(const Condition& before) {
  if (condition_.state == State::kStopping && before.state != State::kStopping) {
    still_ = 0;
    stopping_since_ = Clock::now();
  }
  if (condition_.pending != before.pending) pending_since_ = Clock::now();
  if (!in_motion(before.state) || in_motion(condition_.state)) return;
  course_.reset();
  auto outcome = MotionReport::Outcome::kFailed;
  if (condition_.cause == Cause::kNone) {
    const bool done = condition_.state == State::kIdle;
    outcome = done ? MotionReport::Outcome::kDone : MotionReport::Outcome::kStopped;
  }
  log_.end(outcome, condition_.cause, axis_ ? axis_->alarm_code : 0);
}

void Owner::send_stop() {
  stop_sent_ = Clock::now();
  stopper_.stop();
  // On a line that was just lost this would have to wait; the stopper does not.
  if (lookout_.is_up()) (void)drive_.stop();
}

/// Fails with the first thing that the drive did not take; a stop and taking torque away are
/// repeated until they can be seen, so they do not count.
Status Owner::act(const Actions& actions) {
  if (actions.stop) send_stop();
  if (actions.disable && lookout_.is_up()) (void)drive_.disable();
  if (actions.clear_alarm) HP_RETURN_IF_ERROR(drive_.reset_fault());
  if (actions.enable) HP_RETURN_IF_ERROR(drive_.enable());
  return {};
}

void Owner::keep_going() {
  if (condition_.pending != Pending::kNone && seconds_since(pending_since_) > kPendingPatience_s) {
    apply({Kind::kTimedOut});
  }
  if (condition_.motion == Motion::kJog &&
      seconds_since(jogged_) >= drive_.profile().jog_refresh_s / 2) {
    jogged_ = Clock::now();
    (void)drive_.jog(course_->plan().jog_mm_per_s);  // one that is missing ends by itself
  }
  if (condition_.state != State::kStopping || !lookout_.is_up()) return;
  const double braking_s =
      config_.max_speed_mm_per_s / drive_.profile().stopping_deceleration_mm_per_s2;
  if (seconds_since(stopping_since_) > braking_s + kObeyMargin_s) {
    lookout_.lose();
    lose();
  } else if (seconds_since(stop_sent_) >= kStopAgain_s) {
    send_stop();
  }
}

void Owner::publish() {
  Snapshot now;
  now.condition = condition_;
  now.time = lookout_.clean();
  now.has_axis = axis_.has_value();
  if (axis_) {
    now.bits = bits_of(*axis_);
    now.position_mm = axis_->position_mm;
    now.velocity_mm_per_s = axis_->velocity_mm_per_s;
    now.alarm_code = axis_->alarm_code;
  }
  now.watchdog_s = lookout_.watchdog_s();
  now.motion = log_.latest();
  now.missed_polls = lookout_.missed();
  now.connects = lookout_.connects();
  now.jitter = jitter_;
  desk_.board.snapshot.store(now);
  (void)desk_.board.put(lookout_.trouble());  // the next time, if somebody is reading
  stopper_.watch(in_motion(condition_.state), lookout_.clean());
  for (auto& [promise, answer] : answers_) promise.set_value(std::move(answer));
  answers_.clear();
}

}  // namespace hydroprint::rig
