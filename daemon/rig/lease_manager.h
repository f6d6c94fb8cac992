#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "daemon/platform/clock.h"
#include "daemon/store/database/database.h"
#include "daemon/store/job.h"

namespace hydroprint::daemon {

/// The right to command the rig, for a time. Times are Unix times in ms.
struct Lease {
  std::string id;  ///< unguessable; what commands must name
  std::string holder;
  std::string purpose;
  std::int64_t acquire_ms = 0;
  std::int64_t expire_ms = 0;
};

/// Who may command the rig: one row of the store, which survives the daemon, and a copy in memory,
/// by which commands are checked: none of them waits for the disk. Any thread may call.
class LeaseManager {
 public:
  LeaseManager(Database& database, Clock clock);

  /// Reads the row; to be called once, at the start.
  [[nodiscard]] Status load();

  /// The lease that holds now.
  [[nodiscard]] std::optional<Lease> current() const;

  /// @return kAborted, LEASE_HELD while somebody has it; REQUEST_ID_REUSED; LEASE_REQUIRED if the
  ///   one that this very request took has ended since
  [[nodiscard]] Result<Lease> acquire(const std::string& holder, const std::string& purpose,
                                      std::int64_t ttl_ms, const RequestKey& request);
  /// @return LEASE_REQUIRED
  [[nodiscard]] Result<Lease> renew(const std::string& id, std::int64_t ttl_ms);
  /// Ends the lease of this id; that lease, or none if it is not so any more.
  [[nodiscard]] Result<std::optional<Lease>> release(const std::string& id);
  /// Ends whatever lease there is.
  [[nodiscard]] Result<std::optional<Lease>> take_away();
  /// The lease whose time ran out since this was asked last, if one did.
  [[nodiscard]] std::optional<Lease> take_expired();

  /// The lease if it is this one, else kFailedPrecondition, LEASE_REQUIRED.
  [[nodiscard]] Result<Lease> require(const std::string& id) const;

  /// Does `action`, which returns a Result and must not wait, unless require(id) refuses; no lease
  /// ends meanwhile.
  template <class Action>
  auto with(const std::string& id, const Action& action) const -> decltype(action()) {
    const std::lock_guard lock(now_);
    HP_RETURN_IF_ERROR(required(id));
    return action();
  }

 private:
  [[nodiscard]] std::optional<Lease> held() const;  // the following need now_
  [[nodiscard]] Result<Lease> required(const std::string& id) const;
  void set(std::optional<Lease> lease);
  [[nodiscard]] Status write(const Lease& lease);
  [[nodiscard]] Result<std::optional<Lease>> end(const std::optional<Lease>& ended);

  Database& database_;
  Clock clock_;
  std::mutex writing_;  // of whoever changes the row; never needed to command
  mutable std::mutex now_;
  std::optional<Lease> lease_;
};

}  // namespace hydroprint::daemon
