#include "daemon/rig/to_proto_rig.h"

#include <google/protobuf/util/message_differencer.h>

#include "daemon/platform/resource_names.h"
#include "daemon/store/to_proto.h"
#include "hardware/rig/errors.h"
#include "hardware/rig/limits.h"
#include "hardware/rig/state_names.h"

namespace hydroprint::daemon {
namespace {

// Converts steady-clock time to wall-clock time.
google::protobuf::Timestamp wall_time(rig::TimePoint time) {
  using namespace std::chrono;
  const auto ago = duration_cast<milliseconds>(steady_clock::now() - time);
  return time_of(system_clock_ms() - ago.count());
}

v1::Rig::State state_of(rig::State state) {
  switch (state) {
    case rig::State::kOffline:
      return v1::Rig::OFFLINE;
    case rig::State::kDisarmed:
      return v1::Rig::DISARMED;
    case rig::State::kUnhomed:
      return v1::Rig::UNHOMED;
    case rig::State::kIdle:
      return v1::Rig::IDLE;
    case rig::State::kMoving:
      return v1::Rig::MOVING;
    case rig::State::kDipping:
      return v1::Rig::DIPPING;
    case rig::State::kStopping:
      return v1::Rig::STOPPING;
    case rig::State::kFault:
      return v1::Rig::FAULT;
    case rig::State::kEstopped:
      return v1::Rig::ESTOPPED;
  }
  return v1::Rig::OFFLINE;
}

v1::Motion::Kind kind_of(rig::Motion motion) {
  switch (motion) {
    case rig::Motion::kNone:
      return v1::Motion::KIND_UNSPECIFIED;
    case rig::Motion::kHome:
      return v1::Motion::HOME;
    case rig::Motion::kMove:
      return v1::Motion::MOVE;
    case rig::Motion::kJog:
      return v1::Motion::JOG;
    case rig::Motion::kDip:
      return v1::Motion::DIP;
  }
  return v1::Motion::KIND_UNSPECIFIED;
}

v1::Motion::Outcome outcome_of(rig::MotionReport::Outcome outcome) {
  switch (outcome) {
    case rig::MotionReport::Outcome::kRunning:
      return v1::Motion::RUNNING;
    case rig::MotionReport::Outcome::kDone:
      return v1::Motion::DONE;
    case rig::MotionReport::Outcome::kStopped:
      return v1::Motion::STOPPED;
    case rig::MotionReport::Outcome::kFailed:
      return v1::Motion::FAILED;
  }
  return v1::Motion::OUTCOME_UNSPECIFIED;
}

std::string cause_of(rig::Cause cause) {
  return cause == rig::Cause::kNone ? std::string() : std::string(name(cause));
}

void set_motion(const rig::MotionReport& report, v1::Motion& out) {
  out.set_number(report.number);
  out.set_kind(kind_of(report.motion));
  out.set_outcome(outcome_of(report.outcome));
  out.set_cause(cause_of(report.cause));
  out.set_at_rest(report.at_rest);
  out.set_begin_mm(report.begin_mm);
  out.set_end_mm(report.end_mm);
}

void set_axis(const rig::Controller& controller, double watchdog_s, v1::Axis& out) {
  const rig::RigConfig& config = controller.config();
  const drive::DriveProfile& profile = controller.profile();
  const rig::Range limits = rig::soft_limits(config);
  out.set_drive(profile.name);
  out.set_is_virtual(profile.is_virtual);
  out.set_min_mm(limits.low_mm);
  out.set_max_mm(limits.high_mm);
  out.set_max_speed_mm_per_s(config.max_speed_mm_per_s);
  out.set_stopping_distance_mm(
      rig::stopping_distance_mm(config, profile, config.max_speed_mm_per_s));
  out.set_watchdog_s(watchdog_s);
}

v1::LinkQuality::Scheduling scheduling_of(Scheduling scheduling) {
  switch (scheduling) {
    case Scheduling::kUnknown:
      return v1::LinkQuality::SCHEDULING_UNSPECIFIED;
    case Scheduling::kRealTime:
      return v1::LinkQuality::REAL_TIME;
    case Scheduling::kRaised:
      return v1::LinkQuality::RAISED_PRIORITY;
    case Scheduling::kNormal:
      return v1::LinkQuality::NORMAL_PRIORITY;
  }
  return v1::LinkQuality::SCHEDULING_UNSPECIFIED;
}

void set_replies(const drive::LinkStatistics& link, v1::LinkQuality& out) {
  out.set_damaged_replies(link.damaged_replies);
  out.set_unanswered_requests(link.unanswered_requests);
  out.set_retried_reads(link.retried_reads);
  out.set_reply_time_sum_s(link.reply_time_sum_s);
  for (std::size_t i = 0; i < link.replies.size(); ++i) {
    v1::LinkQuality::ReplyTime& bucket = *out.add_reply_times();
    if (i < drive::kReplyLimits_s.size()) bucket.set_at_most_s(drive::kReplyLimits_s.at(i));
    bucket.set_replies(link.replies.at(i));
  }
}

void set_link_quality(const rig::Snapshot& now, v1::LinkQuality& out) {
  out.set_missed_polls(now.missed_polls);
  out.set_connects(now.connects);
  out.set_polls(now.jitter.ticks);
  out.set_skipped_polls(now.jitter.skipped);
  out.set_largest_lateness_s(now.jitter.largest_s);
  out.set_rms_lateness_s(now.jitter.rms_s);
  out.set_late_polls(now.jitter.late);
  out.set_scheduling(scheduling_of(now.priority.scheduling));
  out.set_memory_locked(now.priority.memory_locked);
  set_replies(now.link, out);
}

void set_alarm(const drive::DriveProfile& profile, int code, v1::Rig& out) {
  out.set_alarm_code(code);
  const auto known = profile.alarms.find(code);
  if (known == profile.alarms.end()) return;
  out.set_alarm_text(known->second.text + "; " + known->second.hint);
}

std::string trouble_of(const rig::Controller& controller, const rig::Condition& condition) {
  // Comes first, because a person must act now.
  const bool is_stop_ignored = condition.cause == rig::Cause::kStopNotObeyed;
  if (is_stop_ignored) return rig::failed(condition.cause).message;
  if (const auto trouble = controller.trouble()) return trouble->message;
  if (condition.cause != rig::Cause::kNone) return rig::failed(condition.cause).message;
  return "";
}

void set_drive(const rig::Controller& controller, v1::Rig& out) {
  const rig::Snapshot now = controller.snapshot();
  out.set_state(state_of(now.condition.state));
  out.set_cause(cause_of(now.condition.cause));
  out.set_trouble(trouble_of(controller, now.condition));
  out.set_homed(now.condition.homed);
  out.set_stop_button(now.condition.button);
  if (now.has_axis) {
    out.set_enabled(now.bits.enabled);
    out.set_position_mm(now.position_mm);
    out.set_velocity_mm_per_s(now.velocity_mm_per_s);
    set_alarm(controller.profile(), now.alarm_code, out);
    *out.mutable_sample_time() = wall_time(now.time);
  }
  if (const auto motion = controller.motion(now.motion)) set_motion(*motion, *out.mutable_motion());
  set_axis(controller, now.watchdog_s, *out.mutable_axis());
  set_link_quality(now, *out.mutable_link_quality());
}

void set_state(const RigGateway& gateway, v1::Rig& out) {
  if (gateway.controller() != nullptr) {
    set_drive(*gateway.controller(), out);
  } else {
    out.set_state(v1::Rig::OFFLINE);
    out.set_trouble(no_rig().value().message);
  }
  if (const auto lease = gateway.leases().current())
    *out.mutable_lease() = to_message(*lease, false);
  if (gateway.dip() != 0) out.set_dip(job_name(gateway.dip()));
}

}  // namespace

bool looks_same(v1::Rig a, v1::Rig b) {
  for (v1::Rig* rig : {&a, &b}) {
    rig->clear_revision();
    rig->clear_sample_time();
    rig->clear_link_quality();
  }
  return google::protobuf::util::MessageDifferencer::Equals(a, b);
}

v1::Rig rig_message(const RigGateway& gateway) {
  v1::Rig out;
  gateway.read_in_order([&](std::int64_t revision) {
    out.set_revision(revision);
    set_state(gateway, out);
  });
  return out;
}

v1::Lease to_message(const Lease& lease, bool with_id) {
  v1::Lease out;
  if (with_id) out.set_lease_id(lease.id);
  out.set_holder(lease.holder);
  out.set_purpose(lease.purpose);
  *out.mutable_acquire_time() = time_of(lease.acquire_ms);
  *out.mutable_expire_time() = time_of(lease.expire_ms);
  return out;
}

}  // namespace hydroprint::daemon
