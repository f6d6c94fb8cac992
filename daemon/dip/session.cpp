#include "daemon/dip/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "daemon/dip/operator_messages.h"
#include "daemon/jobs/report.h"
#include "daemon/platform/durable_file.h"
#include "daemon/platform/log.h"
#include "daemon/platform/resource_names.h"
#include "daemon/store/artifact_files.h"
#include "daemon/store/set_aside.h"
#include "daemon/store/to_proto.h"
#include "hardware/rig/errors.h"
#include "hardware/rig/limits.h"
#include "hydroprint/v1/job.pb.h"
#include "proto/warning_message.h"

namespace hydroprint::daemon {
namespace {

using dip::Ending;
using dip::Event;
using dip::Step;
using std::chrono::milliseconds;

// Reports are limited because each is a transaction on disk.
constexpr milliseconds kProgressInterval{250};
constexpr milliseconds kFlushInterval{250};
constexpr std::chrono::seconds kStoreAgainAfter{1};
// Time allowed for reaching standstill, in addition to the computed stopping time.
constexpr double kRestMargin_s = 1;
constexpr std::size_t kMostSamples =
    500'000;  // maximum number of descent samples, from which the speed is computed

JobState job_state(const dip::Stand& stand) {
  return dip::awaits(stand.step) == dip::Awaits::kOperator ? JobState::kWaitingForOperator
                                                           : JobState::kRunning;
}

JobState job_state(Ending ending) {
  switch (ending) {
    case Ending::kSucceeded:
      return JobState::kSucceeded;
    case Ending::kCancelled:
      return JobState::kCancelled;
    case Ending::kInterrupted:
      return JobState::kInterrupted;
    case Ending::kNone:
    case Ending::kFailed:
      break;
  }
  return JobState::kFailed;
}

void log_failure(const char* event, std::int64_t job, const Status& status) {
  if (!status) log(LogLevel::kError, event, {{"job", job}, {"message", status.error().message}});
}

v1::DipStatus status_of(Step step, const std::string& instruction, const dip::Plan& plan) {
  v1::DipStatus out;
  out.set_step(static_cast<v1::DipStatus::Step>(step));
  out.set_instruction(instruction);
  out.set_immersion(plan.immersion);
  out.set_immersions(plan.immersions);
  if (plan.contact_mm) out.set_contact_mm(*plan.contact_mm);
  if (plan.plan_job.empty()) return out;
  out.set_plan_job(plan.plan_job);
  out.set_picture(fmt::format("{}/artifacts/stretch-{}.png", plan.plan_job, plan.immersion));
  return out;
}

}  // namespace

std::string first_dip_status(const dip::Plan& plan) {
  v1::DipStatus out = status_of(Step::kPrintFilm, dip::instruction(Step::kPrintFilm, plan), plan);
  add_warnings(plan.warnings, *out.mutable_warnings());
  return out.SerializeAsString();
}

DipSession::DipSession(const DipDependencies& dependencies, const Job& job, const dip::Plan& plan,
                       const std::string& holder)
    : dependencies_(dependencies),
      job_(job.id),
      begun_(SteadyClock::now()),
      begun_ms_(dependencies_.clock()),
      log_(dependencies_.layout.dip(job.id), begun_) {
  facts_.job = job_name(job.id);
  facts_.create_time = time_text(job.create_ms);
  facts_.drive = rig().profile().name;
  facts_.is_virtual = rig().profile().is_virtual;
  facts_.lease_holder = holder;
  facts_.plan = plan;
  facts_.warnings = plan.warnings;
  facts_.steps.push_back({Step::kPrintFilm, 0, {}, {}, ""});
  facts_.outcome = name_of(JobState::kRunning);
  write_record();
}

double DipSession::seconds_at(rig::TimePoint time) const {
  return std::chrono::duration<double>(time - begun_).count();
}

std::int64_t DipSession::wall_ms(double seconds) const {
  return begun_ms_ + static_cast<std::int64_t>(1000 * seconds);
}

double DipSession::acceleration() const { return rig().profile().acceleration_mm_per_s2; }

Status DipSession::check_confirm(Step step) const {
  const bool takes_position = step == Step::kLoadObject || step == Step::kFindContact;
  if (!takes_position || step != stand_.step) return {};
  HP_RETURN_IF_ERROR(dependencies_.gateway.check_at_rest());
  const bool takes_measured = step == Step::kFindContact && facts_.plan.contact_mm;
  if (!takes_measured || dependencies_.places.place().homings == facts_.plan.homings) return {};
  return tl::unexpected(Error{Code::kFailedPrecondition,
                              fmt::format("the rig has been homed since {} was made, so first "
                                          "contact is unknown; cancel this dip and calibrate again",
                                          facts_.plan.calibration),
                              ErrorReason::CALIBRATION_STALE,
                              {{"calibration", facts_.plan.calibration}, {"why", "HOMED"}}});
}

Status DipSession::confirm(Step step, const std::string& holder) {
  HP_RETURN_IF_ERROR(check_confirm(step));
  confirmed_by_ = holder;
  Status done = feed({Event::Kind::kConfirm, 0, step});
  confirmed_by_.clear();
  return done;
}

void DipSession::break_off(Event::Kind why) { (void)feed({why}); }

/// Applies an event. If the rig refuses the action, the step does not change.
Status DipSession::feed(Event event) {
  if (event.time_s == 0) event.time_s = seconds_at(SteadyClock::now());
  const bool is_measured = stand_.step == Step::kFindContact && facts_.plan.contact_mm;
  event.position_mm = is_measured ? *facts_.plan.contact_mm : rig().snapshot().position_mm;
  const dip::Outcome outcome = dip::proceed(stand_, event, facts_.plan.clocks);
  if (outcome.refused) {
    return tl::unexpected(
        Error{Code::kFailedPrecondition,
              fmt::format("{} is in step {} and does not wait for {}; see dip_status of the job",
                          facts_.job, name(stand_.step), name(event.step)),
              ErrorReason::STATE_FORBIDS,
              {{"step", std::string(name(stand_.step))}}});
  }
  HP_RETURN_IF_ERROR(act(outcome.action, outcome.next));
  adopt(outcome.next);
  return {};
}

Status DipSession::act(dip::Action action, const dip::Stand& next) {
  const dip::Plan& plan = facts_.plan;
  switch (action) {
    case dip::Action::kNone:
      return {};
    case dip::Action::kStop:
      rig().stop();
      return {};
    case dip::Action::kRise: {
      HP_ASSIGN_OR_RETURN(
          const dip::Ways ways,
          dip::ways_from(plan, *next.contact_mm, *next.loaded_mm, rig().config(), rig().profile()));
      const rig::Leg leg = dip::rise(plan, ways);
      dependencies_.gateway.claim(true);
      const Status taken = order(rig().move_to(leg.target_mm, leg.speed_mm_per_s));
      if (!taken) dependencies_.gateway.claim(plan.clocks.skip);
      HP_RETURN_IF_ERROR(taken);
      facts_.ways = ways;
      return {};
    }
    case dip::Action::kDip:
      HP_RETURN_IF_ERROR(order(rig().dip(dip::legs(plan, *facts_.ways))));
      dependencies_.places.note_dip();
      return {};
  }
  return {};
}

Status DipSession::order(std::future<rig::Answer> taken) {
  HP_ASSIGN_OR_RETURN(motion_, taken.get());
  const auto report = rig().motion(motion_);
  next_sample_ = report ? report->first_sample : 0;
  return {};
}

void DipSession::adopt(const dip::Stand& next) {
  const dip::Stand before = std::exchange(stand_, next);
  if (next.late && !before.late) {
    const double ago_s = seconds_at(SteadyClock::now()) - *next.sprayed_s;
    facts_.warnings.push_back({WarningCode::FILM_LATE,
                               dip::late_words(ago_s, facts_.plan.clocks),
                               {OfItem{std::string(name(next.step))}}});
    publish(facts_.warnings.back().message);
  }
  if (next.step != before.step) {
    // Updates the warning with the final delay.
    if (before.step == Step::kStartDip && next.late) {
      const double ago_s = next.since_s - *next.sprayed_s;
      facts_.warnings.back().message = dip::late_words(ago_s, facts_.plan.clocks);
    }
    note_step(next);
    publish(dip::instruction(next.step, facts_.plan));
  }
  if (next.ending != Ending::kNone && before.ending == Ending::kNone) {
    dependencies_.gateway.claim(false);
    facts_.steps.back().end_s = next.ending_s;
  }
}

void DipSession::note_step(const dip::Stand& next) {
  facts_.steps.back().end_s = next.since_s;
  facts_.steps.back().confirmed_by = confirmed_by_;
  dip::StepRecord record{next.step, next.since_s, {}, {}, ""};
  if (dip::awaits(next.step) != dip::Awaits::kOperator) {
    record.planned_s = dip::planned_s(next.step, facts_.plan, facts_.ways, acceleration());
  }
  facts_.steps.push_back(std::move(record));
}

void DipSession::fail_for(const Error& error) {
  if (stand_.ending == Ending::kNone) failure_ = error;
}

void DipSession::look() {
  take_samples();
  if (motion_ != 0) {
    // Also if the ending is decided: a person must know.
    const rig::Cause cause = rig().snapshot().condition.cause;
    if (cause == rig::Cause::kStopNotObeyed) failure_ = rig::failed(cause);
    look_at_motion();
  } else {
    look_at_rest();
  }
}

/// Writes new samples to the log, and keeps those of the descent.
void DipSession::take_samples() {
  if (motion_ == 0 || next_sample_ == 0) return;
  const auto report = rig().motion(motion_);
  if (!report || report->last_sample < next_sample_) return;
  const auto samples = rig().samples(next_sample_, report->last_sample);
  next_sample_ = report->last_sample + 1;
  const bool dips = report->motion == rig::Motion::kDip;
  log_.add(samples, dips ? "dip" : "clear", *stand_.contact_mm);
  for (const rig::Sample& sample : samples) {
    if (dips) follow(sample);
  }
}

void DipSession::follow(const rig::Sample& sample) {
  const double depth_mm = sample.position_mm - *stand_.contact_mm;
  facts_.deepest_mm = std::max(facts_.deepest_mm.value_or(depth_mm), depth_mm);
  if (sample.leg == 0 && sample.cruising && descent_.size() < kMostSamples) {
    descent_.push_back(sample);
  }
  const double from_bottom_mm = std::abs(sample.position_mm - facts_.ways->bottom_mm);
  const bool at_depth = sample.leg == 0 && from_bottom_mm <= rig().config().arrival_mm;
  const double time_s = seconds_at(sample.time);
  if (at_depth || sample.leg == 1) (void)feed({Event::Kind::kAtDepth, time_s});
  if (sample.leg == 1) (void)feed({Event::Kind::kRising, time_s});
}

void DipSession::look_at_motion() {
  using Outcome = rig::MotionReport::Outcome;
  const auto report = rig().motion(motion_);
  if (!report) return;
  const double ended_s = seconds_at(report->ended);
  if (report->outcome == Outcome::kFailed) {
    fail_for(rig::failed(report->cause));
    (void)feed({Event::Kind::kMotionFailed, ended_s});
  } else if (report->outcome == Outcome::kStopped) {
    (void)feed({Event::Kind::kMotionStopped, ended_s});
  }
  const double patience_s = rig::stopping_time_s(rig().config(), rig().profile()) + kRestMargin_s;
  const bool ending = stand_.ending != Ending::kNone;
  const bool waited = ending && seconds_at(SteadyClock::now()) > stand_.ending_s + patience_s;
  const bool at_rest =
      report->outcome != Outcome::kRunning && report->at_rest && report->last_sample < next_sample_;
  if (!at_rest && !waited) return;
  motion_ = 0;
  if (report->outcome == Outcome::kDone) (void)feed({Event::Kind::kMotionDone, ended_s});
  (void)feed({Event::Kind::kAtRest});
}

void DipSession::look_at_rest() {
  if (!dip::has_the_rig(stand_.step) || stand_.ending != Ending::kNone) return;
  const rig::Condition condition = rig().snapshot().condition;
  if (condition.homed) return;  // every fault of the rig requires homing again
  const auto refusal = rig::step(condition, {rig::Event::Kind::kMove}).refusal;
  // The axis may have moved. The cause is more helpful than "homing required".
  fail_for(condition.cause != rig::Cause::kNone ? rig::failed(condition.cause)
                                                : rig::refused(*refusal, condition));
  (void)feed({Event::Kind::kPlaceLost});
}

bool DipSession::step() {
  look();
  dip::Step before;
  do {  // steps that have nothing to wait for end immediately
    before = stand_.step;
    if (const Status done = feed({Event::Kind::kTick}); !done) {
      fail_for(done.error());
      (void)feed({Event::Kind::kOrderRefused});
    }
  } while (stand_.step != before);
  if (stand_.over) return finish();
  report_progress();
  const auto now = SteadyClock::now();
  if (now >= next_flush_) {
    next_flush_ = now + kFlushInterval;
    note_record(log_.flush());
  }
  return false;
}

Progress DipSession::progress() const {
  const dip::ProgressEstimate estimate = dip::estimate_progress(
      stand_, seconds_at(SteadyClock::now()), facts_.plan, facts_.ways, acceleration());
  const auto remaining_ms = static_cast<std::int64_t>(1000 * estimate.remaining_s);
  return {estimate.fraction, std::string(name(stand_.step)), estimate.step_fraction,
          dependencies_.clock() + remaining_ms};
}

void DipSession::report_progress() {
  const auto now = SteadyClock::now();
  if (job_state(stand_) != JobState::kRunning || stand_.ending != Ending::kNone) return;
  if (now < next_progress_) return;
  next_progress_ = now + kProgressInterval;
  log_failure("progress_lost", job_, dependencies_.jobs.report(job_, progress()));
}

std::string DipSession::words() const {
  if (stand_.ending == Ending::kNone) return dip::instruction(stand_.step, facts_.plan);
  return stand_.ending == Ending::kSucceeded ? dip::afterwards(facts_.plan)
                                             : dip::advice(stand_.step);
}

std::string DipSession::status() const {
  const bool ended = stand_.ending != Ending::kNone;
  v1::DipStatus out = status_of(stand_.step, words(), facts_.plan);
  const auto& planned_s = facts_.steps.back().planned_s;
  if (planned_s && !ended) {
    *out.mutable_step_end_time() = time_of(wall_ms(stand_.since_s + *planned_s));
  }
  if (stand_.sprayed_s) {
    const dip::Clocks& clocks = facts_.plan.clocks;
    *out.mutable_activation_end_time() =
        time_of(wall_ms(*stand_.sprayed_s + clocks.activator_wait_s + clocks.activation_window_s));
  }
  if (stand_.contact_mm) out.set_contact_mm(*stand_.contact_mm);
  add_warnings(facts_.warnings, *out.mutable_warnings());
  return out.SerializeAsString();
}

/// Stores the state of the dip, with a message for its events.
void DipSession::publish(const std::string& message) {
  if (stand_.ending != Ending::kNone) return;
  log_failure(
      "dip_step_lost", job_,
      dependencies_.device_jobs.advance(job_, job_state(stand_), status(), progress(), message));
  log(LogLevel::kInfo, "dip_step",
      {{"job", job_}, {"step", name(stand_.step)}, {"message", message}});
  write_record();
}

void DipSession::write_record() {
  facts_.stand = stand_;
  note_record(log_.flush());
  note_record(dip::write_report(dependencies_.layout.dip(job_), dip::report_of(facts_)));
}

/// Logs only the first failed write of the record; the dip continues.
void DipSession::note_record(const Status& written) {
  if (written || std::exchange(record_told_, true)) return;
  log_failure("record_not_written", job_, written);
}

std::string DipSession::end_words() const {
  const std::string failure = failure_ ? failure_->message + "; " : "";
  const std::string where = fmt::format("{}: {}", name(stand_.step), dip::advice(stand_.step));
  switch (stand_.ending) {
    case Ending::kSucceeded:
      return dip::afterwards(facts_.plan);
    case Ending::kCancelled:
      return failure + "ended on request during " + where;
    case Ending::kInterrupted:
      return failure + "the daemon was shut down during " + where;
    default:
      return (failure_ ? failure : "the rig failed; ") + "during " + where;
  }
}

/// If the record cannot be stored, the dip ends without it, because its outcome is more important.
std::vector<Artifact> DipSession::publish_record() {
  write_record();
  auto published =
      publish_artifacts(dependencies_.layout.dip(job_), dependencies_.layout.artifacts(job_));
  if (published) return std::move(*published);
  log(LogLevel::kError, "record_lost", {{"job", job_}, {"message", published.error().message}});
  discard(dependencies_.layout.dip(job_));
  return {};
}

bool DipSession::finish() {
  if (SteadyClock::now() < next_end_) return false;
  const JobState state = job_state(stand_.ending);
  std::optional<JobFailure> failure;
  if (state == JobState::kFailed) {
    failure = {failure_.value_or(Error{Code::kInternal, "", ErrorReason::RIG_FAULTED, {}}), {}, {}};
    failure->error.message = end_words();
  }
  if (!record_) {
    facts_.outcome = name(stand_.ending);
    facts_.reason = failure ? failure->error.reason : ErrorReason{};
    facts_.message = end_words();
    if (stand_.contact_mm && !descent_.empty()) {
      facts_.descent = dip::immersion_speed(descent_, descent_.front().motion, *stand_.contact_mm);
    }
    record_ = publish_record();
  }
  const auto ended =
      dependencies_.device_jobs.end(job_, state, failure, status(), *record_, end_words());
  if (!ended) {
    next_end_ = SteadyClock::now() + kStoreAgainAfter;
    log(LogLevel::kError, "job_end_lost", {{"job", job_}, {"message", ended.error().message}});
    return false;
  }
  log(LogLevel::kInfo, "job_ended",
      {{"job", job_}, {"state", name_of(ended->state)}, {"message", end_words()}});
  return true;
}

Status end_lost_dips(DeviceJobs& jobs, const Layout& layout) {
  HP_ASSIGN_OR_RETURN(const auto lost, jobs.open_dips());
  std::set<std::int64_t> ended;
  for (const Job& job : lost) {
    v1::DipStatus status;
    status.ParseFromString(job.dip_status);
    const auto step = static_cast<Step>(
        std::clamp<int>(status.step(), static_cast<int>(Step::kPrintFilm), dip::kSteps));
    const std::string words =
        fmt::format("the daemon was restarted during {}: {}", name(step), dip::advice(step));
    status.set_instruction(dip::advice(step));
    status.clear_step_end_time();
    std::vector<Artifact> record;
    const auto folder = layout.dip(job.id);
    if (auto report = read_report(folder, "dip")) {
      report->mutable_dip()->set_outcome(std::string(name(Ending::kInterrupted)));
      report->mutable_dip()->set_message(words);
      const Status written = dip::write_report(folder, report->dip());
      log_failure("record_not_written", job.id, written);
    }
    if (std::filesystem::exists(folder / kReport)) {
      if (auto published = publish_artifacts(folder, layout.artifacts(job.id))) record = *published;
    }
    HP_RETURN_IF_ERROR(
        jobs.end(job.id, JobState::kInterrupted, {}, status.SerializeAsString(), record, words));
    ended.insert(job.id);
  }
  SetAside set_aside(layout, system_clock_ms());
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(layout.dips(), ignored)) {
    if (ended.contains(parse_number(entry.path().filename().string()))) continue;
    HP_RETURN_IF_ERROR(set_aside.move(entry.path()));
  }
  discard(layout.dips());
  return make_folder(layout.dips());
}

}  // namespace hydroprint::daemon
