#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "daemon/platform/clock.h"
#include "daemon/store/database/database.h"
#include "daemon/store/job.h"

namespace hydroprint::daemon {

/// The right to command the rig for a limited time. Times are Unix times in ms.
struct Lease {
  std::string id;  ///< random, so it cannot be guessed; every command must contain it
  std::string holder;
  std::string purpose;
  std::int64_t acquire_ms = 0;
  std::int64_t expire_ms = 0;
};

/// Manages the lease of the rig. The lease is one row of the store. Commands are checked against a
/// copy in memory, so no command waits for the disk. Thread-safe.
class LeaseManager {
 public:
  LeaseManager(Database& database, Clock clock);

  /// Reads the row. Must be called once, at startup.
  [[nodiscard]] Status load();

  /// Returns the active lease, if any.
  [[nodiscard]] std::optional<Lease> current() const;

  /// @return kAborted, LEASE_HELD if another client has the lease; REQUEST_ID_REUSED;
  ///         LEASE_REQUIRED if the lease that the first request with this id acquired has ended
  [[nodiscard]] Result<Lease> acquire(const std::string& holder, const std::string& purpose,
                                      std::int64_t ttl_ms, const RequestKey& request);
  /// @return LEASE_REQUIRED
  [[nodiscard]] Result<Lease> renew(const std::string& id, std::int64_t ttl_ms);
  /// Ends the lease with this id and returns it; nullopt if it is no longer active.
  [[nodiscard]] Result<std::optional<Lease>> release(const std::string& id);
  /// Ends the active lease, if any.
  [[nodiscard]] Result<std::optional<Lease>> take_away();
  /// Returns the lease that expired since the last call, if any.
  [[nodiscard]] std::optional<Lease> take_expired();

  /// Returns the active lease if it has this id, otherwise kFailedPrecondition, LEASE_REQUIRED.
  [[nodiscard]] Result<Lease> require(const std::string& id) const;

  /// Runs `action` if require(id) succeeds. The lease cannot end while the action runs. `action`
  /// returns a Result and must not wait.
  template <class Action>
  auto with(const std::string& id, const Action& action) const -> decltype(action()) {
    const std::lock_guard lock(now_);
    HP_RETURN_IF_ERROR(required(id));
    return action();
  }

 private:
  [[nodiscard]] std::optional<Lease> held() const;  // the caller must hold now_
  [[nodiscard]] Result<Lease> required(const std::string& id) const;
  void set(std::optional<Lease> lease);
  [[nodiscard]] Status write(const Lease& lease);
  [[nodiscard]] Result<std::optional<Lease>> end(const std::optional<Lease>& ended);

  Database& database_;
  Clock clock_;
  std::mutex writing_;  // locked while the row changes; never needed for commands
  mutable std::mutex now_;
  std::optional<Lease> lease_;
};

}  // namespace hydroprint::daemon
