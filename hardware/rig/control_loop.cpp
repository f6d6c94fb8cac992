#include "hardware/rig/control_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>

#include "hardware/rig/errors.h"
#include "hardware/rig/limits.h"
#include "hardware/rig/order_checks.h"
#include "hardware/rig/state_names.h"

namespace hydroprint::rig {
namespace {

using Clock = std::chrono::steady_clock;
using Kind = Event::Kind;

// Above ordinary threads and any other threads with a low real-time priority, below the kernel's.
constexpr int kLoopPriority = 10;
constexpr double kPendingPatience_s = 2;
constexpr double kStopAgain_s = 0.2;
constexpr int kStandstillPolls = 2;
// Time after the watchdog's own time, by which the watchdog must have acted.
constexpr double kWatchdogMargin_s = 0.05;
// Added to the computed braking time. An axis that still moves after this does not obey the stop.
constexpr double kStopMargin_s = 0.5;
// Added to the computed stopping time before an axis that cannot be polled counts as at rest.
constexpr double kStandstillMargin_s = 0.5;

/// Whether the drive may have obeyed a command despite this error: its reply was lost or damaged.
bool may_have_arrived(const Error& error) {
  return error.metadata.contains("timeout") || error.reason == ErrorReason::REPLY_INVALID;
}

double seconds_since(TimePoint time) {
  return std::chrono::duration<double>(Clock::now() - time).count();
}

}  // namespace

ControlLoop::ControlLoop(const RigConfig& config, drive::Drive& drive, StopChannel& stop_channel,
                         SharedState& shared)
    : config_(config),
      drive_(drive),
      stop_channel_(stop_channel),
      shared_(shared),
      link_monitor_(drive),
      observer_(config_, drive.profile()),
      log_(shared.status) {}

/// Locks the memory that each tick uses: this object, the drive, the shared state and the samples.
ThreadPriority ControlLoop::raise_priority() const {
  ThreadPriority out = become_real_time(kLoopPriority);
  const auto samples = shared_.status.samples.memory();
  out.memory_locked =
      out.memory_locked && lock_memory(this, sizeof *this) && lock_memory(&drive_, sizeof drive_) &&
      lock_memory(&shared_, sizeof shared_) && lock_memory(samples.data(), samples.size());
  return out;
}

void ControlLoop::run() {
  priority_ = raise_priority();
  const auto period = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(config_.poll_period_s));
  TimePoint due = Clock::now();
  double squares = 0;
  while (!shared_.end) {
    std::this_thread::sleep_until(due);
    const double late_s = seconds_since(due);
    squares += late_s * late_s;
    ++jitter_.ticks;
    if (late_s > config_.poll_period_s / 2) ++jitter_.late;
    jitter_.largest_s = std::max(jitter_.largest_s, late_s);
    jitter_.rms_s = std::sqrt(squares / static_cast<double>(jitter_.ticks));
    tick();
    for (due += period; due < Clock::now(); due += period) ++jitter_.skipped;
  }
  shut_down();
}

void ControlLoop::shut_down() {
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
  stop_channel_.watch(false, link_monitor_.clean());
  if (link_monitor_.is_up())
    (void)drive_.disable();  // if this fails, the drive's watchdog stops the axis
  drive_.disconnect();
}

void ControlLoop::tick() {
  take_stops();
  look();
  take_orders();
  keep_going();
  publish();
}

void ControlLoop::take_stops() {
  if (stop_channel_.consume_trip()) {  // this thread was late with its polls
    link_monitor_.lose();
    lose();
  }
  const std::uint64_t stop_count = shared_.stops;
  if (stop_count == stops_) return;
  stops_ = stop_count;
  apply({Kind::kStop});
}

/// Reports standstill after a stop only once two consecutive polls show it, because a motion that
/// was commanded earlier may still begin.
Bits ControlLoop::settled(Bits bits) {
  if (condition_.state != State::kStopping) return bits;
  still_ = bits.moving ? 0 : still_ + 1;
  bits.moving = still_ < kStandstillPolls;
  return bits;
}

void ControlLoop::look() {
  auto seen = link_monitor_.look();
  if (seen.event && seen.event->kind == Kind::kLost) return lose();
  if (seen.axis) {
    axis_ = std::move(*seen.axis);
    seen.event->bits = settled(seen.event->bits);
    if (seen.event->kind == Kind::kSeen) {
      stop_channel_.prepare();
      stopping_since_ = Clock::now();  // if STOPPING: only now can the drive obey again
    }
  }
  if (seen.event) apply(*seen.event);
  if (seen.axis) {
    follow(*axis_);
    if (axis_) record(*axis_);  // else the line has fallen silent
    return;
  }
  const double unseen_s = seconds_since(link_monitor_.clean());
  if (condition_.state == State::kStopping && condition_.link == Link::kNone &&
      unseen_s > stopping_time_s(config_, drive_.profile()) + kStandstillMargin_s) {
    apply({Kind::kStandstillAssumed});
  }
}

/// Handles a lost link. If the drive may be moving and may not have received the stop, this thread
/// sends nothing until the drive's watchdog has acted: any message would keep the drive moving.
void ControlLoop::lose() {
  axis_.reset();
  observer_.forget();
  apply({Kind::kLost});
  if (condition_.state == State::kStopping) link_monitor_.keep_silent(silence_s());
}

/// The time of silence after which the drive's watchdog has acted.
double ControlLoop::silence_s() const {
  const double patience_s = std::chrono::duration<double>(StopChannel::kPatience).count();
  return patience_s + link_monitor_.watchdog_s() + kWatchdogMargin_s;
}

/// Returns whether the samples show a fault.
bool ControlLoop::observe(const drive::DriveState& axis) {
  if (!stop_acknowledged_ && stop_channel_.acknowledged() > stopping_since_) {
    stop_acknowledged_ = stop_channel_.acknowledged();
  }
  const auto* supervisor = supervisor_ ? &*supervisor_ : nullptr;
  const auto cause = observer_.look(condition_, supervisor, axis, stop_acknowledged_);
  if (!cause) return false;
  if (*cause == Cause::kStopNotObeyed) {
    fall_silent(*cause);
  } else {
    apply({.kind = Kind::kFault, .cause = *cause});
  }
  return true;
}

/// Nothing more is sent, so that the drive's watchdog stops the axis.
void ControlLoop::fall_silent(Cause cause) {
  stop_channel_.keep_silent(std::chrono::duration<double>(silence_s()));
  apply({.kind = Kind::kFault, .cause = cause});
  link_monitor_.lose();
  lose();
}

void ControlLoop::follow(const drive::DriveState& axis) {
  if (observe(axis) || !supervisor_ || observer_.in_doubt()) return;
  const MotionSupervisor::Advice advice = supervisor_->look(axis);
  const bool is_sent = !advice.next || send_surely([&] { return command_leg(*advice.next); });
  if (!is_sent) apply({.kind = Kind::kFault, .cause = Cause::kFollowingError});
  if (advice.event) apply(*advice.event);
}

void ControlLoop::record(const drive::DriveState& axis) {
  Sample sample;
  sample.time = axis.time;
  sample.time_error_s = axis.time_error.count();
  sample.position_mm = axis.position_mm;
  sample.velocity_mm_per_s = axis.velocity_mm_per_s;
  sample.expected_mm = std::numeric_limits<double>::quiet_NaN();
  sample.motion = log_.current();
  sample.state = condition_.state;
  if (supervisor_) supervisor_->note(sample);
  sample.number = shared_.status.samples.add(sample);
  log_.see(sample, condition_.state != State::kStopping && !bits_of(axis).moving);
}

Step ControlLoop::apply(const Event& event) {
  const Condition before = condition_;
  const Step taken = step(before, event);
  condition_ = taken.next;
  note_change(before);
  if (!act(taken.actions) && condition_.pending != Pending::kNone) apply({Kind::kTimedOut});
  answer_waiting();
  return taken;
}

void ControlLoop::note_change(const Condition& before) {
  if (condition_.state == State::kStopping && before.state != State::kStopping) {
    still_ = 0;
    stopping_since_ = Clock::now();
    stop_acknowledged_.reset();
  }
  if (condition_.pending != before.pending) pending_since_ = Clock::now();
  if (!in_motion(before.state) || in_motion(condition_.state)) return;
  supervisor_.reset();
  auto outcome = MotionReport::Outcome::kFailed;
  if (condition_.cause == Cause::kNone) {
    const bool done = condition_.state == State::kIdle;
    outcome = done ? MotionReport::Outcome::kDone : MotionReport::Outcome::kStopped;
  }
  log_.end(outcome, condition_.cause, axis_ ? axis_->alarm_code : 0);
}

void ControlLoop::send_stop() {
  stop_sent_ = Clock::now();
  stop_channel_.stop();
  // After a lost link this call would have to wait; stop_channel_ does not.
  if (link_monitor_.is_up() && drive_.stop() && !stop_acknowledged_) {
    stop_acknowledged_ = Clock::now();
  }
}

/// Returns the error of the first command that the drive did not accept. Errors of stop and disable
/// are ignored, because both are repeated until the drive reports their effect.
Status ControlLoop::act(const Actions& actions) {
  if (actions.stop) send_stop();
  if (actions.disable && link_monitor_.is_up()) (void)drive_.disable();
  Status sent;
  if (actions.clear_alarm) sent = drive_.reset_fault();
  if (actions.enable) sent = drive_.enable();
  // Polls show whether the drive has obeyed.
  if (!sent && may_have_arrived(sent.error())) return {};
  return sent;
}

void ControlLoop::keep_going() {
  if (condition_.pending != Pending::kNone && seconds_since(pending_since_) > kPendingPatience_s) {
    apply({Kind::kTimedOut});
  }
  if (condition_.motion == Motion::kJog &&
      seconds_since(jogged_) >= drive_.profile().jog_refresh_s / 2) {
    jogged_ = Clock::now();
    // An error is ignored: without its repeated commands, the jog ends by itself.
    (void)drive_.jog(supervisor_->plan().jog_mm_per_s);
  }
  if (condition_.state != State::kStopping || !link_monitor_.is_up()) return;
  const double braking_s =
      config_.max_speed_mm_per_s / drive_.profile().stopping_deceleration_mm_per_s2;
  if (seconds_since(stopping_since_) > braking_s + kStopMargin_s) {
    fall_silent(Cause::kStopNotObeyed);
  } else if (seconds_since(stop_sent_) >= kStopAgain_s) {
    send_stop();
  }
}

void ControlLoop::take_orders() {
  if (stop_channel_.is_busy()) return;  // the orders are taken at the next tick
  for (Order& order : shared_.orders.take()) carry_out(order);
}

void ControlLoop::answer(Order& order, Answer answer) {
  answers_.emplace_back(std::move(order.answer), std::move(answer));
}

void ControlLoop::carry_out(Order& order) {
  if (const auto refusal = step(condition_, {order.kind}).refusal) {
    const auto& trouble = link_monitor_.trouble();
    const bool says_more =
        trouble && (*refusal == Refusal::kOffline || *refusal == Refusal::kConfigUnsafe);
    Error error = says_more ? after_start(*trouble) : refused(*refusal, condition_);
    error.metadata["state"] = name(condition_.state);
    answer(order, tl::unexpected(std::move(error)));
    return;
  }
  if (Status sound = check_order(order, shared_.stops, config_, drive_.profile(), axis_); !sound) {
    answer(order, tl::unexpected(std::move(sound).error()));
    return;
  }
  if (apply({order.kind}).actions.start) {
    answer(order, begin(order));
  } else {
    waiting_.push_back(std::move(order));
    answer_waiting();
  }
}

Answer ControlLoop::begin(const Order& order) {
  const TimePoint now = Clock::now();
  if (supervisor_) {  // an ongoing jog
    supervisor_->hold_jog(order.given, now, order.plan.jog_mm_per_s);
  } else {
    supervisor_.emplace(config_, drive_.profile(), order.plan, now, axis_->position_mm);
    if (order.kind == Kind::kJog) supervisor_->hold_jog(order.given, now, order.plan.jog_mm_per_s);
    log_.begin(order.plan.motion, now, axis_->position_mm);
  }
  if (Status sent = send_surely([&] { return command(order); }); !sent) {
    apply({Kind::kStop});  // the command may have arrived
    return tl::unexpected(after_start(std::move(sent).error()));
  }
  return log_.latest();
}

/// Sends a command that starts a motion. If its reply is lost, the drive is read: if it does not
/// move, the command is sent once more. Repeated commands have the same target, so they do no harm.
Status ControlLoop::send_surely(const std::function<Status()>& send) {
  Status sent = send();
  if (sent || !may_have_arrived(sent.error())) return sent;
  const auto seen = link_monitor_.look();
  if (seen.event && seen.event->kind == Kind::kLost) lose();
  if (!seen.axis) return sent;
  apply(*seen.event);
  if (!in_motion(condition_.state)) return sent;
  return seen.axis->moving ? Status{} : send();
}

Status ControlLoop::command(const Order& order) {
  if (order.kind == Kind::kHome) return drive_.home();
  if (order.kind != Kind::kJog) return command_leg(order.plan.legs.front());
  jogged_ = Clock::now();
  return drive_.jog(order.plan.jog_mm_per_s);
}

Status ControlLoop::command_leg(const Leg& leg) {
  supervisor_->begin_leg(Clock::now());
  return drive_.move_to(leg.target_mm, leg.speed_mm_per_s);
}

/// Answers orders whose confirmation is no longer pending.
void ControlLoop::answer_waiting() {
  if (condition_.pending != Pending::kNone) return;
  for (Order& order : std::exchange(waiting_, {})) {
    const bool failed = (order.kind == Kind::kArm && !is_armed(condition_.state)) ||
                        (order.kind == Kind::kReset && condition_.cause != Cause::kNone);
    if (!failed) {
      answer(order, 0);
      continue;
    }
    Error error{Code::kAborted,
                "the drive did not confirm the command; check the drive's display and try again",
                ErrorReason::STATE_FORBIDS,
                {{"state", std::string(name(condition_.state))}}};
    answer(order, tl::unexpected(std::move(error)));
  }
}

void ControlLoop::refuse_all() {
  std::deque<Order> orders = shared_.orders.take_all();
  for (Order& order : waiting_) orders.push_back(std::move(order));
  waiting_.clear();
  for (Order& order : orders)
    order.answer.set_value(
        aborted("the daemon is shutting down, so the command may not have been executed; try again "
                "after it has restarted"));
}

void ControlLoop::publish() {
  Snapshot now;
  now.condition = condition_;
  now.time = link_monitor_.clean();
  now.has_axis = axis_.has_value();
  if (axis_) {
    now.bits = bits_of(*axis_);
    now.position_mm = axis_->position_mm;
    now.velocity_mm_per_s = axis_->velocity_mm_per_s;
    now.alarm_code = axis_->alarm_code;
  }
  now.watchdog_s = link_monitor_.watchdog_s();
  now.motion = log_.latest();
  now.missed_polls = link_monitor_.missed();
  now.connects = link_monitor_.connects();
  now.link = drive_.link()->statistics();
  now.jitter = jitter_;
  now.priority = priority_;
  shared_.status.snapshot.store(now);
  (void)shared_.status.put(link_monitor_.trouble());  // if locked, retried at the next tick
  stop_channel_.watch(in_motion(condition_.state), link_monitor_.clean());
  for (auto& [promise, answer] : answers_) promise.set_value(std::move(answer));
  answers_.clear();
}

}  // namespace hydroprint::rig
