#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/dip/plan.h"
#include "daemon/dip/record.h"
#include "daemon/platform/clock.h"
#include "daemon/rig/rig_gateway.h"
#include "daemon/rig/rig_reference.h"
#include "daemon/store/calibration_store.h"
#include "daemon/store/device_jobs.h"
#include "daemon/store/job_store.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// The objects that dips use.
struct DipDependencies {
  RigGateway& gateway;
  RigReference& places;
  JobStore& jobs;
  DeviceJobs& device_jobs;
  CalibrationStore& calibrations;
  Layout layout;
  Clock clock;
};

/// Returns the initial dip status of a job, serialised.
[[nodiscard]] std::string first_dip_status(const dip::Plan& plan);

/// One dip, from its creation to its end in the store. Asks dip::proceed for the next action,
/// commands the rig, updates the store and keeps the record. Not thread-safe.
class DipSession {
 public:
  /// @param job  the job, just created; the rig must be configured, homed and at rest
  DipSession(const DipDependencies& dependencies, const Job& job, const dip::Plan& plan,
             const std::string& holder);

  [[nodiscard]] std::int64_t job() const { return job_; }

  /// Confirms a step for the operator, who holds the lease. Waits until the rig has accepted the
  /// next command.
  /// @return STATE_FORBIDS, LIMIT_EXCEEDED, and refusals of the rig; after an error the dip stays
  ///         in its step
  [[nodiscard]] Status confirm(dip::Step step, const std::string& holder);
  /// Ends the dip as soon as the axis is at rest. Errors are not reported.
  void break_off(dip::Event::Kind why);

  /// Checks the rig and the clocks, and performs the next action. Returns true once the end of the
  /// dip is stored; a failed write is retried.
  [[nodiscard]] bool step();

 private:
  using SteadyClock = std::chrono::steady_clock;

  [[nodiscard]] rig::Controller& rig() const { return *dependencies_.gateway.controller(); }
  [[nodiscard]] double seconds_at(rig::TimePoint time) const;
  [[nodiscard]] std::int64_t wall_ms(double seconds) const;
  [[nodiscard]] double acceleration() const;

  [[nodiscard]] Status feed(dip::Event event);
  [[nodiscard]] Status act(dip::Action action, const dip::Stand& next);
  [[nodiscard]] Status order(std::future<rig::Answer> taken);
  [[nodiscard]] Status check_confirm(dip::Step step) const;
  void adopt(const dip::Stand& next);
  void note_step(const dip::Stand& next);

  void look();
  void look_at_motion();
  void follow(const rig::Sample& sample);
  void look_at_rest();
  void take_samples();

  void publish(const std::string& message);
  void report_progress();
  [[nodiscard]] Progress progress() const;
  [[nodiscard]] std::string words() const;
  [[nodiscard]] std::string status() const;
  void write_record();
  void note_record(const Status& written);

  void fail_for(const Error& error);
  [[nodiscard]] bool finish();
  [[nodiscard]] std::vector<Artifact> publish_record();
  [[nodiscard]] std::string end_words() const;

  DipDependencies dependencies_;
  std::int64_t job_;
  dip::Stand stand_;
  dip::Facts facts_;
  SteadyClock::time_point begun_;
  std::int64_t begun_ms_;
  std::string confirmed_by_;  // lease holder who confirmed the step that is ending

  std::uint64_t motion_ = 0;  // number of the motion until it is at rest; 0: none
  std::uint64_t next_sample_ = 0;
  std::vector<rig::Sample> descent_;
  dip::PositionLog log_;

  std::optional<Error> failure_;
  std::optional<std::vector<Artifact>> record_;
  bool record_told_ = false;
  SteadyClock::time_point next_progress_, next_flush_, next_end_;
};

/// Ends dips that were open when the daemon crashed: publishes the record and sets the job to
/// INTERRUPTED, with advice for the operator. Call this before serving clients.
[[nodiscard]] Status end_lost_dips(DeviceJobs& jobs, const Layout& layout);

}  // namespace hydroprint::daemon
