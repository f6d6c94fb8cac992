#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "daemon/rig/lease_manager.h"
#include "hardware/rig/controller.h"

namespace hydroprint::daemon {

/// Entry point for commands to the rig. Checks the lease and that no dip has exclusive use. Keeps
/// the id of the unfinished dip, and the callers that requested stops. Thread-safe; never waits for
/// the drive or the disk.
class RigGateway {
 public:
  /// @param controller  null if no rig is configured; must outlive this object
  RigGateway(rig::Controller* controller, LeaseManager& leases)
      : controller_(controller), leases_(leases) {}

  /// Returns null if no rig is configured.
  [[nodiscard]] rig::Controller* controller() const { return controller_; }
  [[nodiscard]] LeaseManager& leases() const { return leases_; }

  using Order = std::function<std::future<rig::Answer>(rig::Controller&)>;
  /// Passes a command to the controller. Errors: LEASE_REQUIRED; RIG_OFFLINE if no rig is
  /// configured; STATE_FORBIDS while a dip has exclusive use.
  [[nodiscard]] Result<std::future<rig::Answer>> order(const std::string& lease_id,
                                                       const Order& order);
  /// Same as order(), for Controller::jog.
  [[nodiscard]] Result<std::future<rig::Answer>> jog(const std::string& lease_id,
                                                     double speed_mm_per_s);

  /// Stores who requested a stop, for the log entry written by RigMonitor.
  void note_stop(const std::string& who);
  /// Returns the callers that requested stops since the last call: the first 64.
  [[nodiscard]] std::vector<std::string> take_stops();
  /// Stops a jog, if there is one, because its client has lost the lease.
  void end_jog();

  /// Returns an error if the rig's state forbids a move, for example because it is not homed or in
  /// motion. Also returns an error shortly after a jog was requested, because the jog may not have
  /// started yet.
  [[nodiscard]] Status check_at_rest() const;

  /// Sets the id of the unfinished dip; 0: none.
  void set_dip(std::int64_t job) { dip_ = job; }
  [[nodiscard]] std::int64_t dip() const { return dip_; }
  /// Sets whether the dip has exclusive use of the rig.
  void claim(bool by_dip) { claimed_ = by_dip; }

  /// Calls `read` with a revision. Only one thread at a time reads, so a greater revision never
  /// belongs to an older state. Revisions also increase across restarts of the daemon, unless the
  /// wall clock is set back in between.
  void read_in_order(const std::function<void(std::int64_t revision)>& read) const;

 private:
  [[nodiscard]] Status check_free() const;
  [[nodiscard]] bool jogged_lately() const;

  rig::Controller* controller_;
  LeaseManager& leases_;
  std::atomic<std::int64_t> dip_{0};
  std::atomic<bool> claimed_{false};
  std::atomic<std::int64_t> jogged_ms_{0};  // steady clock; 0: never
  mutable std::mutex revision_mutex_;
  mutable std::int64_t revision_ = 0;  // of the latest reading; microseconds of the wall clock
  std::mutex stops_mutex_;
  std::vector<std::string> stops_;
};

/// Returns the error kFailedPrecondition, RIG_OFFLINE: no rig is configured.
[[nodiscard]] tl::unexpected<Error> no_rig();

}  // namespace hydroprint::daemon
