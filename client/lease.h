#pragma once

#include <chrono>
#include <string>

#include "client/connection/connection.h"
#include "hydroprint/v1/rig.pb.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// Returns the public part of the lease; kNotFound (LEASE_NOT_FOUND) if nobody holds it.
[[nodiscard]] Result<v1::Lease> get_lease(Connection& connection);

/// Acquires the lease if nobody holds it.
/// @param ttl  1 s to 8 h
/// @return kAborted (LEASE_HELD; metadata holder, purpose, expire_time) while somebody holds it
[[nodiscard]] Result<v1::Lease> acquire_lease(Connection& connection, const std::string& purpose,
                                              std::chrono::seconds ttl);

/// Extends the lease to `ttl` from now. @return kFailedPrecondition (LEASE_REQUIRED) if it is no
/// longer ours
[[nodiscard]] Result<v1::Lease> renew_lease(Connection& connection, const std::string& lease_id,
                                            std::chrono::seconds ttl);

/// Releases the lease; not an error if it is no longer ours. A jog ends.
[[nodiscard]] Status release_lease(Connection& connection, const std::string& lease_id);

/// Takes the lease away from its holder, with a reason that the daemon logs. A jog ends; a dip
/// continues.
[[nodiscard]] Status break_lease(Connection& connection, const std::string& reason);

}  // namespace hydroprint::client
