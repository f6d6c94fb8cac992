// Conversions of rig, lease and dip messages.
#include <string>

#include "client/convert.h"

namespace hydroprint::client {
namespace {

namespace v1 = ::hydroprint::v1;

RigState from_proto(v1::Rig::State state) {
  const int number = v1::Rig::State_IsValid(state) ? static_cast<int>(state) : 0;
  return static_cast<RigState>(number);
}

MotionOutcome from_proto(v1::Motion::Outcome outcome) {
  const int number = v1::Motion::Outcome_IsValid(outcome) ? static_cast<int>(outcome) : 0;
  return static_cast<MotionOutcome>(number);
}

// The enumerators match the API's names and order; convert_test.cpp checks this.
static_assert(static_cast<int>(RigState::kEstopped) == v1::Rig::ESTOPPED);
static_assert(static_cast<int>(MotionOutcome::kFailed) == v1::Motion::FAILED);
static_assert(static_cast<int>(DipStep::kRetract) == v1::DipStatus::RETRACT);

Motion from_proto(const v1::Motion& message) {
  return {message.number(),
          v1::Motion::Kind_Name(message.kind()),
          from_proto(message.outcome()),
          message.cause(),
          message.at_rest(),
          message.begin_mm(),
          message.end_mm()};
}

Axis from_proto(const v1::Axis& message) {
  return {message.drive(),     message.is_virtual(),         message.min_mm(),
          message.max_mm(),    message.max_speed_mm_per_s(), message.stopping_distance_mm(),
          message.watchdog_s()};
}

LinkQuality from_proto(const v1::LinkQuality& message) {
  return {message.missed_polls(),  message.connects(),           message.polls(),
          message.skipped_polls(), message.largest_lateness_s(), message.rms_lateness_s()};
}

}  // namespace

Lease from_proto(const v1::Lease& message) {
  return {message.lease_id(), message.holder(), message.purpose(),
          from_proto(message.has_acquire_time(), message.acquire_time()),
          from_proto(message.has_expire_time(), message.expire_time())};
}

Rig from_proto(const v1::Rig& message) {
  Rig rig;
  rig.state = from_proto(message.state());
  rig.cause = message.cause();
  rig.trouble = message.trouble();
  rig.homed = message.homed();
  rig.stop_button = message.stop_button();
  rig.enabled = message.enabled();
  rig.position_mm = given(message.has_position_mm(), message.position_mm());
  rig.velocity_mm_per_s = given(message.has_velocity_mm_per_s(), message.velocity_mm_per_s());
  rig.alarm_code = message.alarm_code();
  rig.alarm_text = message.alarm_text();
  rig.sample_time = from_proto(message.has_sample_time(), message.sample_time());
  if (message.has_motion()) rig.motion = from_proto(message.motion());
  if (message.has_axis()) rig.axis = from_proto(message.axis());
  rig.link_quality = from_proto(message.link_quality());
  if (message.has_lease()) rig.lease = from_proto(message.lease());
  rig.dip = message.dip();
  return rig;
}

DipSpec from_proto(const v1::DipSpec& message) {
  DipSpec spec;
  spec.simulate_job = message.simulate_job();
  spec.depth_mm = given(message.has_depth_mm(), message.depth_mm());
  spec.speed_mm_per_s = given(message.has_speed_mm_per_s(), message.speed_mm_per_s());
  spec.hold_s = given(message.has_hold_s(), message.hold_s());
  spec.retract_speed_mm_per_s =
      given(message.has_retract_speed_mm_per_s(), message.retract_speed_mm_per_s());
  spec.clearance_mm = given(message.has_clearance_mm(), message.clearance_mm());
  spec.film_area_mm2 = given(message.has_film_area_mm2(), message.film_area_mm2());
  spec.activator_ml_per_m2 =
      given(message.has_activator_ml_per_m2(), message.activator_ml_per_m2());
  spec.soak_s = given(message.has_soak_s(), message.soak_s());
  spec.activator_wait_s = given(message.has_activator_wait_s(), message.activator_wait_s());
  spec.activation_window_s =
      given(message.has_activation_window_s(), message.activation_window_s());
  spec.water_temperature_c =
      given(message.has_water_temperature_c(), message.water_temperature_c());
  spec.yes_to_all = message.yes_to_all();
  spec.calibration = message.calibration();
  spec.allow_stale_calibration = message.allow_stale_calibration();
  return spec;
}

v1::DipSpec to_proto(const DipSpec& spec) {
  v1::DipSpec message;
  message.set_simulate_job(spec.simulate_job);
  if (spec.depth_mm) message.set_depth_mm(*spec.depth_mm);
  if (spec.speed_mm_per_s) message.set_speed_mm_per_s(*spec.speed_mm_per_s);
  if (spec.hold_s) message.set_hold_s(*spec.hold_s);
  if (spec.retract_speed_mm_per_s) message.set_retract_speed_mm_per_s(*spec.retract_speed_mm_per_s);
  if (spec.clearance_mm) message.set_clearance_mm(*spec.clearance_mm);
  if (spec.film_area_mm2) message.set_film_area_mm2(*spec.film_area_mm2);
  if (spec.activator_ml_per_m2) message.set_activator_ml_per_m2(*spec.activator_ml_per_m2);
  if (spec.soak_s) message.set_soak_s(*spec.soak_s);
  if (spec.activator_wait_s) message.set_activator_wait_s(*spec.activator_wait_s);
  if (spec.activation_window_s) message.set_activation_window_s(*spec.activation_window_s);
  if (spec.water_temperature_c) message.set_water_temperature_c(*spec.water_temperature_c);
  message.set_yes_to_all(spec.yes_to_all);
  message.set_calibration(spec.calibration);
  message.set_allow_stale_calibration(spec.allow_stale_calibration);
  return message;
}

DipStatus from_proto(const v1::DipStatus& message) {
  DipStatus status;
  status.step = dip_step_of(v1::DipStatus::Step_Name(message.step()));
  status.instruction = message.instruction();
  status.step_end_time = from_proto(message.has_step_end_time(), message.step_end_time());
  status.activation_end_time =
      from_proto(message.has_activation_end_time(), message.activation_end_time());
  status.contact_mm = given(message.has_contact_mm(), message.contact_mm());
  status.warnings.assign(message.warnings().begin(), message.warnings().end());
  return status;
}

v1::DipStatus::Step to_proto(DipStep step) {
  v1::DipStatus::Step result = v1::DipStatus::STEP_UNSPECIFIED;
  v1::DipStatus::Step_Parse(std::string(name_of(step)), &result);
  return result;
}

}  // namespace hydroprint::client
