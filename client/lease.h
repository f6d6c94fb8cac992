#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "client/connection/connection.h"
#include "client/time.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// The exclusive right to command the rig, for a time. Stop needs none.
struct Lease {
  std::string lease_id;  ///< what commands must name; only after acquire_lease and renew_lease
  std::string holder;    ///< who has it: the connection's owner, a claim
  std::string purpose;
  std::optional<Time> acquire_time;
  std::optional<Time> expire_time;  ///< unless it is renewed
};

/// The lease as everyone may see it; kNotFound (LEASE_NOT_FOUND) if nobody has it.
[[nodiscard]] Result<Lease> get_lease(Connection& connection);

/// Takes the lease if nobody has it.
/// @param ttl  1 s to 8 h
/// @return kAborted (LEASE_HELD; metadata holder, purpose, expire_time) while somebody has it
[[nodiscard]] Result<Lease> acquire_lease(Connection& connection, const std::string& purpose,
                                          std::chrono::seconds ttl);

/// Lets it end `ttl` from now. @return kFailedPrecondition (LEASE_REQUIRED) if it is ours no more
[[nodiscard]] Result<Lease> renew_lease(Connection& connection, const std::string& lease_id,
                                        std::chrono::seconds ttl);

/// Gives it back; no error if it is ours no more. A jog ends.
[[nodiscard]] Status release_lease(Connection& connection, const std::string& lease_id);

/// Takes it away from whoever has it, with a reason that the daemon logs. A jog ends, a dip goes
/// on.
[[nodiscard]] Status break_lease(Connection& connection, const std::string& reason);

}  // namespace hydroprint::client
