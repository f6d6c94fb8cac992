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

/// Where commands to the rig come together: what they need (the lease; no dip that has the rig to
/// itself), and what others want to know of them. Any thread may call; nothing waits, neither for
/// the drive nor for the disk.
class RigGateway {
 public:
  /// @param controller  null if no rig is configured; outlives this
  RigGateway(rig::Controller* controller, LeaseManager& leases)
      : controller_(controller), leases_(leases) {}

  /// Null if no rig is configured.
  [[nodiscard]] rig::Controller* controller() const { return controller_; }
  [[nodiscard]] LeaseManager& leases() const { return leases_; }

  using Order = std::function<std::future<rig::Answer>(rig::Controller&)>;
  /// Gives an order unless it is refused: LEASE_REQUIRED, RIG_OFFLINE if no rig is configured,
  /// STATE_FORBIDS while a dip has the rig.
  [[nodiscard]] Result<std::future<rig::Answer>> order(const std::string& lease_id,
                                                       const Order& order);
  /// The same for Controller::jog.
  [[nodiscard]] Result<std::future<rig::Answer>> jog(const std::string& lease_id,
                                                     double speed_mm_per_s);

  /// Keeps who asked for a stop, for the log, which someone else writes.
  void note_stop(const std::string& who);
  /// Who asked for stops since this was asked last; the oldest may be missing.
  [[nodiscard]] std::vector<std::string> take_stops();
  /// Stops a jog, if one is or may be under way: whoever held it has lost the lease.
  void end_jog();

  /// Refuses what a move would be refused for by the rig's state: not homed, in motion, ...; also
  /// while a jog was asked for a moment ago and may not have begun.
  [[nodiscard]] Status check_at_rest() const;

  /// The dip that is not finished; 0: none.
  void set_dip(std::int64_t job) { dip_ = job; }
  [[nodiscard]] std::int64_t dip() const { return dip_; }
  /// Whether it has the rig to itself.
  void claim(bool by_dip) { claimed_ = by_dip; }

 private:
  [[nodiscard]] Status check_free() const;
  [[nodiscard]] bool jogged_lately() const;

  rig::Controller* controller_;
  LeaseManager& leases_;
  std::atomic<std::int64_t> dip_{0};
  std::atomic<bool> claimed_{false};
  std::atomic<std::int64_t> jogged_ms_{0};  // of the steady clock; 0: never
  std::mutex stops_mutex_;
  std::vector<std::string> stops_;
};

/// kFailedPrecondition, RIG_OFFLINE: no rig is configured.
[[nodiscard]] tl::unexpected<Error> no_rig();

}  // namespace hydroprint::daemon
