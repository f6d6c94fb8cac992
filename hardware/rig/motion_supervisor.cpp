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

double seconds(TimePoint from, TimePoint to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

Status check(const RigConfig& config, const Plan& plan) {
  if (plan.motion == Motion::kJog) return check_speed(config, std::abs(plan.jog_mm_per_s));
  if (plan.motion == Motion::kHome) return {};
  if (plan.legs.empty() || (plan.motion == Motion::kMove && plan.legs.size() != 1)) {
    return fail(Code::kInvalidArgument,
                "the motion has no target, or a move has several; specify one target and its speed",
                "SPEC_INVALID");
  }
  for (const Leg& leg : plan.legs) {
    HP_RETURN_IF_ERROR(check_target(config, leg.target_mm));
    HP_RETURN_IF_ERROR(check_speed(config, leg.speed_mm_per_s));
    if (!(leg.hold_s >= 0 && leg.hold_s <= 3600)) {
      return fail(Code::kOutOfRange, "hold_s must be from 0 to 3600 s", "SPEC_INVALID");
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
      from_mm_(position_mm) {}

double MotionSupervisor::since_leg_s(TimePoint time) const { return seconds(leg_start_, time); }

void MotionSupervisor::begin_leg(TimePoint now) {
  const Leg& leg = plan_.legs[leg_];
  travel_.emplace(from_mm_, leg.target_mm, leg.speed_mm_per_s, profile_.acceleration_mm_per_s2);
  leg_start_ = now;
  arrived_.reset();
}

void MotionSupervisor::hold_jog(TimePoint now, double speed_mm_per_s) {
  held_ = std::max(held_, now);
  plan_.jog_mm_per_s = speed_mm_per_s;
}

MotionSupervisor::Advice MotionSupervisor::look(const drive::DriveState& drive) {
  if (plan_.motion == Motion::kHome) return look_at_home(drive);
  if (outside_limits(config_, drive.position_mm, start_mm_)) return {Kind::kOutsideLimits, {}};
  return plan_.motion == Motion::kJog ? look_at_jog(drive) : look_at_leg(drive);
}

MotionSupervisor::Advice MotionSupervisor::look_at_home(const drive::DriveState& drive) {
  const double t_s = seconds(start_, drive.time);
  seen_moving_ = seen_moving_ || drive.moving;
  if (t_s > config_.home_timeout_s) return {Kind::kFollowingError, {}};
  if (drive.moving || (!seen_moving_ && t_s < kHomingShows_s)) return {};
  return {drive.homed ? Kind::kMotionDone : Kind::kFollowingError, {}};
}

MotionSupervisor::Advice MotionSupervisor::look_at_jog(const drive::DriveState& drive) const {
  if (seconds(held_, drive.time) > kPresence_s) return {Kind::kJogOver, {}};
  if (!may_jog(config_, profile_, drive.position_mm, plan_.jog_mm_per_s)) {
    return {Kind::kJogOver, {}};
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
    return {Kind::kFollowingError, {}};
  }
  if (!arrived_) {
    const bool there = t_s >= travel_->duration_s() && !drive.moving &&
                       std::abs(drive.position_mm - leg.target_mm) <= config_.arrival_mm;
    if (there) arrived_ = drive.time;
    if (!there && t_s > travel_->duration_s() + kLate_s) return {Kind::kFollowingError, {}};
  }
  if (!arrived_ || seconds(*arrived_, drive.time) < leg.hold_s) return {};
  if (leg_ + 1 == plan_.legs.size()) return {Kind::kMotionDone, {}};
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
