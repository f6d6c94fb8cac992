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
#include "daemon/store/job_store.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// What dips work on.
struct DipSurroundings {
  RigGateway& gateway;
  RigReference& places;
  JobStore& jobs;
  CalibrationStore& calibrations;
  Layout layout;
  Clock clock;
};

/// What the job of a dip shows at its beginning, serialised.
[[nodiscard]] std::string first_dip_status(const dip::Plan& plan);

/// One dip, from its creation to its end in the store: asks dip::proceed what is next, has the rig
/// do it, tells the store, and keeps the record. One thread at a time may call.
class DipSession {
 public:
  /// @param job  just created; the rig is configured, homed and at rest
  DipSession(const DipSurroundings& surroundings, const Job& job, const dip::Plan& plan,
             const std::string& holder);

  [[nodiscard]] std::int64_t job() const { return job_; }

  /// The operator, who has the lease, has done this step. Waits until the rig took what follows.
  /// @return STATE_FORBIDS, LIMIT_EXCEEDED, and what the rig refuses: then the dip stays where it
  /// is
  [[nodiscard]] Status confirm(dip::Step step, const std::string& holder);
  /// Ends it as soon as the axis is at rest; no errors.
  void break_off(dip::Event::Kind why);

  /// Looks at the rig and the clocks and does what is next. True once the dip is ended in the
  /// store; a store that fails is tried again.
  [[nodiscard]] bool step();

 private:
  using SteadyClock = std::chrono::steady_clock;

  [[nodiscard]] rig::Controller& rig() const { return *around_.gateway.controller(); }
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

  void tell(const std::string& message);
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

  DipSurroundings around_;
  std::int64_t job_;
  dip::Stand stand_;
  dip::Facts facts_;
  SteadyClock::time_point begun_;
  std::int64_t begun_ms_;
  std::string confirmed_by_;  // of the step that is being left

  std::uint64_t motion_ = 0;  // under way or not at rest yet; 0: none
  std::uint64_t next_sample_ = 0;
  std::vector<rig::Sample> descent_;
  dip::PositionLog log_;

  std::optional<Error> failure_;
  std::optional<std::vector<Artifact>> record_;
  bool record_told_ = false;
  SteadyClock::time_point next_progress_, next_flush_, next_end_;
};

/// What a dip left whose daemon was lost: its record is published, and its job INTERRUPTED, with
/// what to do. To be called before anyone is served.
[[nodiscard]] Status end_lost_dips(JobStore& jobs, const Layout& layout);

}  // namespace hydroprint::daemon
