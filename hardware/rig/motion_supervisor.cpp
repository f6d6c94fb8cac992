#include "hardware/rig/motion_supervisor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hardware/rig/limits.h"

namespace hydroprint::rig {
namespace {

using Kind = Event::Kind;

// Time within which a drive must show that homing has started.
constexpr double kHomingShows_s = 0.5;
// Time by which a move may exceed its computed duration, for sending the command and for the last
// step.
constexpr double kLate_s = 1;
// Homing ends at position 0, but drives may stop a little beside their switch.
constexpr double kHome_mm = 5;
// Jogs whose speeds differ by less count as the same.
constexpr double kSameSpeed_mm_per_s = 0.05;

MotionSupervisor::Advice failed(Cause cause) {
  return {Event{.kind = Kind::kFault, .cause = cause}, {}};
}
MotionSupervisor::Advice done() { return {Event{Kind::kMotionDone}, {}}; }

}  // namespace

Status check(const RigConfig& config, const Plan& plan) {
  if (plan.motion == Motion::kJog) return check_speed(config, std::abs(plan.jog_mm_per_s));
  if (plan.motion == Motion::kHome) return {};
  if (plan.legs.empty() || (plan.motion == Motion::kMove && plan.legs.size() != 1)) {
    return fail(Code::kInvalidArgument,
                "the motion has no target, or a move has several; specify one target and its speed",
                ErrorReason::SPEC_INVALID);
  }
  for (const Leg& leg : plan.legs) {
    HP_RETURN_IF_ERROR(check_target(config, leg.target_mm));
    HP_RETURN_IF_ERROR(check_speed(config, leg.speed_mm_per_s));
    if (!(leg.hold_s >= 0 && leg.hold_s <= 3600)) {
      return fail(Code::kOutOfRange, "hold_s must be from 0 to 3600 s", ErrorReason::SPEC_INVALID);
    }
  }
  return {};
}

MotionSupervisor::MotionSupervisor(const RigConfig& config, const drive::DriveProfile& profile,
                                   Plan plan, TimePoint start, double position_mm)
    : config_(config),
      profile_(profile),
      plan_(std::move(plan)),
      start_(start),
      start_mm_(position_mm),
      held_(start),
      from_mm_(position_mm) {
  jog_ = {.state = State::kMoving,
          .motion = Motion::kJog,
          .since = start,
          .speed_mm_per_s = plan_.jog_mm_per_s,
          .turned = start};
}

double MotionSupervisor::since_leg_s(TimePoint time) const { return seconds(leg_start_, time); }

void MotionSupervisor::begin_leg(TimePoint now) {
  const Leg& leg = plan_.legs[leg_];
  travel_.emplace(from_mm_, leg.target_mm, leg.speed_mm_per_s, profile_.acceleration_mm_per_s2);
  leg_start_ = now;
  arrived_.reset();
}

void MotionSupervisor::hold_jog(TimePoint asked, TimePoint now, double speed_mm_per_s) {
  held_ = std::max(held_, asked);
  plan_.jog_mm_per_s = speed_mm_per_s;
  if (std::abs(speed_mm_per_s - jog_.speed_mm_per_s) < kSameSpeed_mm_per_s) return;
  jog_.entry_mm_per_s = speed_bound_mm_per_s(profile_, jog_, now);
  if (speed_mm_per_s * jog_.speed_mm_per_s < 0) jog_.turned = now;
  jog_.since = now;
  jog_.speed_mm_per_s = speed_mm_per_s;
}

AxisOrder MotionSupervisor::order() const {
  if (plan_.motion == Motion::kJog) return jog_;
  AxisOrder out{.state = State::kMoving, .motion = plan_.motion, .since = start_};
  if (plan_.motion == Motion::kDip) out.state = State::kDipping;
  if (plan_.legs.empty()) {
    out.speed_mm_per_s = profile_.homing_speed_mm_per_s.value_or(config_.max_speed_mm_per_s);
    return out;
  }
  if (travel_) out.since = leg_start_;
  out.turned = out.since;
  const Leg& leg = plan_.legs[leg_];
  out.speed_mm_per_s = std::copysign(leg.speed_mm_per_s, leg.target_mm - from_mm_);
  return out;
}

MotionSupervisor::Advice MotionSupervisor::look(const drive::DriveState& drive) {
  if (plan_.motion == Motion::kHome) return look_at_home(drive);
  if (outside_limits(config_, drive.position_mm, start_mm_)) return failed(Cause::kGuard);
  return plan_.motion == Motion::kJog ? look_at_jog(drive) : look_at_leg(drive);
}

MotionSupervisor::Advice MotionSupervisor::look_at_home(const drive::DriveState& drive) {
  const double t_s = seconds(start_, drive.time);
  follow_home(drive);
  const double longest_mm = config_.end_high_mm - config_.end_low_mm + config_.keep_out_mm;
  if (t_s > config_.home_timeout_s || std::abs(way_mm_) > longest_mm) {
    return failed(Cause::kHomingFailed);
  }
  if (drive.moving || (!seen_moving_ && t_s < kHomingShows_s)) return {};
  const bool is_home = drive.homed && seen_home_ && std::abs(drive.position_mm) <= kHome_mm;
  return is_home ? done() : failed(Cause::kHomingFailed);
}

/// A homed bit that was set before homing says nothing: it, or the home switch, must be seen to
/// change.
void MotionSupervisor::follow_home(const drive::DriveState& drive) {
  seen_moving_ = seen_moving_ || drive.moving;
  if (before_) {
    seen_home_ =
        seen_home_ || (drive.homed && !before_->homed) || drive.home_switch != before_->home_switch;
    const double step_mm = drive.position_mm - before_->position_mm;
    const double reach_mm =
        1 + 2 * profile_.max_speed_mm_per_s * seconds(before_->time, drive.time);
    if (std::abs(step_mm) <= reach_mm) way_mm_ += step_mm;
  }
  before_ = drive;
}

MotionSupervisor::Advice MotionSupervisor::look_at_jog(const drive::DriveState& drive) const {
  if (seconds(held_, drive.time) > kPresence_s) return {Event{Kind::kJogOver}, {}};
  if (!may_jog(config_, profile_, drive.position_mm, plan_.jog_mm_per_s)) {
    return {Event{Kind::kJogOver}, {}};
  }
  return {};
}

MotionSupervisor::Advice MotionSupervisor::look_at_leg(const drive::DriveState& drive) {
  if (!travel_) return {{}, plan_.legs[leg_]};
  const double t_s = since_leg_s(drive.time);
  const Leg& leg = plan_.legs[leg_];
  const bool under_way = t_s < travel_->duration_s() + config_.following_error_s;
  const double band_mm = following_band_mm(config_, under_way ? travel_->speed_mm_per_s() : 0);
  if (!(std::abs(drive.position_mm - travel_->position_mm(t_s)) <= band_mm)) {
    return failed(Cause::kFollowingError);
  }
  if (!arrived_) {
    const bool there = t_s >= travel_->duration_s() && !drive.moving &&
                       std::abs(drive.position_mm - leg.target_mm) <= config_.arrival_mm;
    if (there) arrived_ = drive.time;
    if (!there && t_s > travel_->duration_s() + kLate_s) return failed(Cause::kFollowingError);
  }
  if (!arrived_ || seconds(*arrived_, drive.time) < leg.hold_s) return {};
  if (leg_ + 1 == plan_.legs.size()) return done();
  ++leg_;
  from_mm_ = drive.position_mm;
  travel_.reset();
  return {{}, plan_.legs[leg_]};
}

void MotionSupervisor::note(Sample& sample) const {
  sample.expected_mm = std::numeric_limits<double>::quiet_NaN();
  if (plan_.legs.empty()) return;
  sample.leg = static_cast<std::int32_t>(leg_);
  if (!travel_) return;
  const double t_s = since_leg_s(sample.time);
  sample.expected_mm = travel_->position_mm(t_s);
  // The speed counts as constant only some time after the computed start, because the command and
  // the drive's reaction may be late.
  sample.cruising =
      t_s > travel_->cruise_begin_s() + config_.following_error_s && t_s < travel_->cruise_end_s();
}

}  // namespace hydroprint::rig
