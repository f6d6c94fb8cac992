#include "tests/hardware/rig/faulty_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hardware/rig/axis_observer.h"
#include "hardware/rig/limits.h"
#include "hardware/rig/link_monitor.h"
#include "hardware/rig/state_names.h"
#include "tests/hardware/rig/axis.h"

namespace hydroprint::rig {
namespace {

constexpr double kFrom_mm = 50;
constexpr double kJog_mm_per_s = 5;
constexpr double kMove_mm_per_s = 10;
constexpr double kHoming_mm_per_s = 8;
constexpr double kPoll_s = 0.02;
constexpr double kDelay_s = 0.03;  // between an order and the axis

/// Where the axis is, and how fast it moves.
struct Place {
  double x_mm = kFrom_mm;
  double v_mm_per_s = 0;
};

/// Returns the place on a move that begins at time 0.
Place on(const Travel& travel, double t_s) {
  constexpr double kStep_s = 1e-4;
  return {travel.position_mm(t_s),
          (travel.position_mm(t_s + kStep_s) - travel.position_mm(t_s)) / kStep_s};
}

/// An axis, its drive's registers and bits, and the order that it obeys until its fault.
class Axis {
 public:
  Axis(Doing doing, AxisFault fault, unsigned seed, bool has_velocity_register)
      : doing_(doing), fault_(fault), random_(seed), has_velocity_register_(has_velocity_register) {
    // A fault in mid-motion or, if it would not show there, from the start.
    const bool at_start = fault == AxisFault::kHomedBitStale ||
                          fault == AxisFault::kVelocityFrozen ||
                          fault == AxisFault::kHomeSwitchBroken;
    fault_s_ = at_start ? 0 : 0.8 + 0.4 * uniform();
    if (doing == Doing::kStopping) fault_s_ = stop_s();
  }

  void begin_leg(double t_s, const Leg& leg) {
    leg_s_ = t_s + kDelay_s;
    leg_.emplace(truth_.x_mm, leg.target_mm, leg.speed_mm_per_s,
                 test_profile().acceleration_mm_per_s2);
  }

  void go_to(double t_s) {
    const Place before = truth_;
    const bool is_faulty = fault_ != AxisFault::kNone && t_s >= fault_s_;
    truth_ = is_faulty ? wrong(t_s, t_s - last_s_) : ordered(t_s);
    if (is_faulty) way_mm_ += std::abs(truth_.x_mm - before.x_mm);
    last_s_ = t_s;
  }

  drive::DriveState registers() {
    drive::DriveState out;
    out.time = at(last_s_);
    out.time_error = std::chrono::duration<double>(0.002);
    const double noise_mm = has_velocity_register_ ? 0.01 : 0.001;
    out.position_mm = truth_.x_mm + noise_mm * (uniform() - 0.5);
    out.velocity_mm_per_s = truth_.v_mm_per_s + 0.1 * (uniform() - 0.5);
    out.enabled = true;
    out.moving = std::abs(truth_.v_mm_per_s) > 0.01;
    out.home_switch = false;
    out.homed = doing_ == Doing::kHome ? is_homed() : doing_ != Doing::kUnhomed;
    falsify(out);
    if (!has_velocity_register_) derive_velocity(out);
    return out;
  }

  void derive_velocity(drive::DriveState& out) {
    constexpr double kStep_mm = 1e-3;  // of the position register
    out.position_mm = std::round(out.position_mm / kStep_mm) * kStep_mm;
    const double dt_s = before_ ? seconds(before_->time, out.time) : 0;
    out.velocity_mm_per_s = dt_s > 0 ? (out.position_mm - before_->position_mm) / dt_s : 0;
    before_ = out;
  }

  [[nodiscard]] double stop_s() const { return 1; }
  [[nodiscard]] double fault_s() const { return fault_s_; }
  [[nodiscard]] double way_mm() const { return way_mm_; }
  double uniform() { return std::uniform_real_distribution<>(0, 1)(random_); }

 private:
  /// The place of an axis that does as ordered.
  [[nodiscard]] Place ordered(double t_s) const {
    const double late_s = std::max(0.0, t_s - kDelay_s);
    const double a = test_profile().acceleration_mm_per_s2;
    switch (doing_) {
      case Doing::kUnhomed:
      case Doing::kIdle:
        return {};
      case Doing::kHome:
        return on(Travel(kFrom_mm, 0, kHoming_mm_per_s, a), late_s);
      case Doing::kJog:
        return on(Travel(kFrom_mm, 1000, kJog_mm_per_s, a), late_s);
      case Doing::kStopping:
        return stopping(t_s);
      default:
        return leg_ ? on(*leg_, t_s - leg_s_) : Place{};
    }
  }
  [[nodiscard]] Place stopping(double t_s) const {
    const Travel jog(kFrom_mm, 1000, kJog_mm_per_s, test_profile().acceleration_mm_per_s2);
    Place out = on(jog, std::min(t_s, stop_s() + kDelay_s));
    const double braking_s = std::max(0.0, t_s - stop_s() - kDelay_s);
    const double a = test_profile().stopping_deceleration_mm_per_s2;
    const double full_s = out.v_mm_per_s / a;
    const double s = std::min(braking_s, full_s);
    out.x_mm += out.v_mm_per_s * s - a * s * s / 2;
    if (braking_s > 0) out.v_mm_per_s -= a * s;
    return out;
  }

  [[nodiscard]] double order_mm_per_s() const {
    return doing_ == Doing::kJog ? kJog_mm_per_s : kMove_mm_per_s;
  }

  /// The speed of an axis with a fault.
  [[nodiscard]] std::optional<double> wrong_mm_per_s() const {
    switch (fault_) {
      case AxisFault::kRunaway:
      case AxisFault::kHiddenRunaway:
        return 25;
      case AxisFault::kFastRunaway:
        return 5 * test_profile().max_speed_mm_per_s;
      case AxisFault::kFrozenRunaway:
      case AxisFault::kStopIgnored:
        return kJog_mm_per_s;
      case AxisFault::kDrift:
        return 0.15;
      case AxisFault::kWrongWay:
        return -order_mm_per_s();
      case AxisFault::kStalled:
      case AxisFault::kHomedBitStale:
        return 0;
      case AxisFault::kTwiceAsFast:
        return 2 * order_mm_per_s();
      case AxisFault::kHomeSwitchBroken:
        return -kHoming_mm_per_s;
      default:
        return std::nullopt;
    }
  }
  [[nodiscard]] Place wrong(double t_s, double dt_s) const {
    const auto v = wrong_mm_per_s();
    return v ? Place{truth_.x_mm + *v * dt_s, *v} : ordered(t_s);
  }

  [[nodiscard]] bool is_homed() const {
    if (fault_ == AxisFault::kHomedBitStale) return true;
    if (fault_ == AxisFault::kHomedElsewhere) return last_s_ > fault_s_;
    return std::abs(truth_.x_mm) < 0.01;
  }

  void falsify(drive::DriveState& out) {
    const bool is_faulty = fault_ != AxisFault::kNone && last_s_ >= fault_s_;
    if (!is_faulty) {
      frozen_mm_ = out.position_mm;
      return;
    }
    if (fault_ == AxisFault::kPositionFrozen || fault_ == AxisFault::kFrozenRunaway) {
      out.position_mm = frozen_mm_;
    }
    if (fault_ == AxisFault::kVelocityFrozen || fault_ == AxisFault::kHiddenRunaway) {
      out.velocity_mm_per_s = 0;
      if (doing_ == Doing::kIdle || doing_ == Doing::kUnhomed) out.moving = false;
    }
    if (fault_ == AxisFault::kZeroed) out.position_mm -= kFrom_mm;
    if (fault_ == AxisFault::kNotANumber) {
      out.position_mm = std::numeric_limits<double>::quiet_NaN();
    }
    if (fault_ == AxisFault::kHomedElsewhere) {
      out.position_mm = 80;
      out.moving = false;
    }
    if (fault_ == AxisFault::kHomedBitStale) out.moving = false;
    if (fault_ == AxisFault::kHomeSwitchBroken) out.moving = true;
  }

  Doing doing_;
  AxisFault fault_;
  std::mt19937 random_;
  bool has_velocity_register_;
  std::optional<drive::DriveState> before_;
  double fault_s_ = 0, last_s_ = 0, leg_s_ = 0, way_mm_ = 0, frozen_mm_ = kFrom_mm;
  Place truth_;
  std::optional<Travel> leg_;
};

Condition condition_of(Doing doing) {
  Condition out{.state = State::kMoving, .link = Link::kSafe, .homed = true};
  switch (doing) {
    case Doing::kUnhomed:
      out.state = State::kUnhomed;
      out.homed = false;
      break;
    case Doing::kIdle:
      out.state = State::kIdle;
      break;
    case Doing::kHome:
      out.motion = Motion::kHome;
      out.homed = false;
      break;
    case Doing::kDip:
      out.state = State::kDipping;
      out.motion = Motion::kDip;
      break;
    case Doing::kMove:
      out.motion = Motion::kMove;
      break;
    default:
      out.motion = Motion::kJog;
  }
  return out;
}

Plan plan_of(Doing doing) {
  switch (doing) {
    case Doing::kHome:
      return {Motion::kHome};
    case Doing::kMove:
      return {Motion::kMove, {{90, kMove_mm_per_s, 0}}};
    case Doing::kDip:
      return {Motion::kDip, {{90, kMove_mm_per_s, 1}, {60, kMove_mm_per_s, 0}}};
    default:
      return {Motion::kJog, {}, kJog_mm_per_s};
  }
}

/// The rig's reaction to one sample: its own fault, that of the motion, or the end of the motion.
class Watch {
 public:
  Watch(Doing doing, bool has_velocity_register)
      : config_(test_config()), profile_(test_profile()), observer_(config_, profile_) {
    if (!has_velocity_register) profile_.velocity.reset();
    condition_ = condition_of(doing);
    if (in_motion(condition_.state)) {
      supervisor_.emplace(config_, profile_, plan_of(doing), at(0), kFrom_mm);
    }
  }

  void look(double t_s, Axis& axis, Noticed& out) {
    const drive::DriveState state = axis.registers();
    const Bits bits = bits_of(state);
    if (supervisor_) supervisor_->hold_jog(at(t_s), at(t_s), kJog_mm_per_s);
    const Step taken = step(condition_, {Event::Kind::kSample, bits});
    condition_ = taken.next;
    out.cause = condition_.cause;
    if (out.cause != Cause::kNone) return;
    const auto* supervisor = supervisor_ ? &*supervisor_ : nullptr;
    const auto seen = observer_.look(condition_, supervisor, state, stopped_);
    if (seen) out.cause = *seen;
    if (seen || supervisor == nullptr || observer_.in_doubt()) return;
    supervise(t_s, state, axis, out);
  }

  void stop(double t_s) {
    condition_.state = State::kStopping;
    condition_.motion = Motion::kNone;
    supervisor_.reset();
    stopped_ = at(t_s);
  }

 private:
  void supervise(double t_s, const drive::DriveState& state, Axis& axis, Noticed& out) {
    const auto advice = supervisor_->look(state);
    if (advice.next) {
      supervisor_->begin_leg(at(t_s));
      axis.begin_leg(t_s, *advice.next);
    }
    if (!advice.event) return;
    out.cause = advice.event->cause;
    out.is_done = advice.event->kind == Event::Kind::kMotionDone ||
                  advice.event->kind == Event::Kind::kJogOver;
  }

  RigConfig config_;
  drive::DriveProfile profile_;
  AxisObserver observer_;
  Condition condition_;
  std::optional<MotionSupervisor> supervisor_;
  std::optional<TimePoint> stopped_;
};

}  // namespace

Noticed play(Doing doing, AxisFault fault, unsigned seed, bool has_velocity_register) {
  Axis axis(doing, fault, seed, has_velocity_register);
  Watch watch(doing, has_velocity_register);
  Noticed out;
  bool is_stopped = false;
  double t_s = 0;
  for (double due_s = 0.02; due_s < 60; due_s += kPoll_s) {
    const double until_s = due_s + 0.008 * axis.uniform();
    for (; t_s < until_s; t_s += 0.001) {
      axis.go_to(t_s);
      if (doing == Doing::kStopping && !is_stopped && t_s >= axis.stop_s()) {
        is_stopped = true;
        watch.stop(t_s);
      }
    }
    watch.look(t_s, axis, out);
    if (out.cause != Cause::kNone || out.is_done) break;
    const bool can_end = doing == Doing::kMove || doing == Doing::kDip || doing == Doing::kHome;
    if (fault == AxisFault::kNone && !can_end && t_s > 20) break;
  }
  out.after_s = t_s - axis.fault_s();
  out.after_mm = axis.way_mm();
  return out;
}

const std::vector<FaultRow>& fault_table() {
  using D = Doing;
  using F = AxisFault;
  constexpr double kSoon_s = 0.15;
  const RigConfig config = test_config();
  const double axis_mm = config.end_high_mm - config.end_low_mm + config.keep_out_mm;
  static const std::vector<FaultRow> rows = {
      {D::kUnhomed, F::kRunaway, Cause::kUnexpectedMotion, kSoon_s},
      {D::kUnhomed, F::kDrift, Cause::kUnexpectedMotion, kSoon_s},
      {D::kIdle, F::kRunaway, Cause::kUnexpectedMotion, kSoon_s},
      {D::kIdle, F::kFastRunaway, Cause::kUnexpectedMotion, kSoon_s},
      {D::kIdle, F::kHiddenRunaway, Cause::kUnexpectedMotion, kSoon_s},
      {D::kIdle, F::kFrozenRunaway, Cause::kUnexpectedMotion, kSoon_s},
      {D::kIdle, F::kDrift, Cause::kUnexpectedMotion, kSoon_s},
      {D::kIdle, F::kZeroed, Cause::kPositionJumped, kSoon_s},
      {D::kIdle, F::kNotANumber, Cause::kFeedback, kSoon_s},
      {D::kJog, F::kRunaway, Cause::kOverspeed, kSoon_s},
      {D::kJog, F::kFastRunaway, Cause::kOverspeed, kSoon_s},
      {D::kJog, F::kTwiceAsFast, Cause::kOverspeed, kSoon_s},
      {D::kJog, F::kHiddenRunaway, Cause::kFeedback, kSoon_s},
      {D::kJog, F::kWrongWay, Cause::kWrongDirection, kSoon_s},
      {D::kJog, F::kStalled, Cause::kFollowingError, 0.3, 0},
      {D::kJog, F::kZeroed, Cause::kPositionJumped, kSoon_s},
      {D::kJog, F::kPositionFrozen, Cause::kFeedback, kSoon_s},
      {D::kJog, F::kVelocityFrozen, Cause::kFeedback, kSoon_s},
      {D::kJog, F::kNotANumber, Cause::kFeedback, kSoon_s},
      {D::kHome, F::kFastRunaway, Cause::kOverspeed, kSoon_s},
      {D::kHome, F::kHiddenRunaway, Cause::kFeedback, kSoon_s},
      {D::kHome, F::kPositionFrozen, Cause::kFeedback, kSoon_s},
      {D::kHome, F::kVelocityFrozen, Cause::kFeedback, kSoon_s},
      {D::kHome, F::kHomedBitStale, Cause::kHomingFailed, 0.6, 0},
      {D::kHome, F::kHomedElsewhere, Cause::kHomingFailed, kSoon_s, 0},
      {D::kHome, F::kHomeSwitchBroken, Cause::kHomingFailed, 0, axis_mm + 1},
      {D::kMove, F::kRunaway, Cause::kOverspeed, kSoon_s},
      {D::kMove, F::kWrongWay, Cause::kWrongDirection, kSoon_s},
      {D::kMove, F::kStalled, Cause::kFollowingError, 0.35, 0},
      {D::kMove, F::kZeroed, Cause::kPositionJumped, kSoon_s},
      {D::kMove, F::kPositionFrozen, Cause::kFeedback, kSoon_s},
      {D::kMove, F::kVelocityFrozen, Cause::kFeedback, kSoon_s},
      {D::kMove, F::kNotANumber, Cause::kFeedback, kSoon_s},
      {D::kDip, F::kRunaway, Cause::kOverspeed, kSoon_s},
      {D::kDip, F::kStalled, Cause::kFollowingError, 0.35, 0},
      {D::kDip, F::kPositionFrozen, Cause::kFeedback, kSoon_s},
      {D::kDip, F::kVelocityFrozen, Cause::kFeedback, kSoon_s},
      {D::kStopping, F::kStopIgnored, Cause::kStopNotObeyed, 0.2},
  };
  return rows;
}

std::string_view words(Doing doing) {
  static constexpr std::array<std::string_view, 7> kWords = {"UNHOMED", "IDLE", "home",    "jog",
                                                             "move",    "dip",  "STOPPING"};
  return kWords.at(static_cast<std::size_t>(doing));
}

std::string_view words(AxisFault fault) {
  static constexpr std::array<std::string_view, 17> kWords = {
      "",
      "moves at 25 mm/s",
      "moves at 5 times the drive's highest speed",
      "moves at 25 mm/s, velocity register at 0",
      "moves at 5 mm/s, position register frozen",
      "drifts at 0.15 mm/s",
      "drive sets its position to zero",
      "position register frozen",
      "velocity register frozen at 0",
      "moves the wrong way",
      "stands still",
      "moves at twice the ordered speed",
      "position is not a number",
      "ends at once, homed bit was set before",
      "ends at 80 mm",
      "home switch never reached",
      "stop acknowledged, not obeyed"};
  return kWords.at(static_cast<std::size_t>(fault));
}

namespace {

std::string limit(const FaultRow& row) {
  const std::string time = fmt::format("{:g} ms", 1000 * row.within_s);
  const std::string way = fmt::format("{:g} mm", row.within_mm);
  if (row.within_s == 0) return way;
  return row.within_mm == 0 ? time : time + " or " + way;
}

}  // namespace

std::string fault_table_markdown() {
  std::string out = "| state or motion | fault | cause | noticed within |\n|---|---|---|---|\n";
  for (const FaultRow& row : fault_table()) {
    out += fmt::format("| {} | {} | {} | {} |\n", words(row.doing), words(row.fault),
                       name(row.cause), limit(row));
  }
  return out;
}

}  // namespace hydroprint::rig
