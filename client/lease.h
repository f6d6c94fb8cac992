#pragma once

#include <chrono>
#include <string>

#include "client/connection/connection.h"
#include "hydroprint/v1/rig.pb.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// Returns the lease without its id; kNotFound (LEASE_NOT_FOUND) if nobody holds it.
[[nodiscard]] Result<v1::Lease> get_lease(Connection& connection);

/// Acquires the lease if it is free.
/// @param ttl  1 s to 8 h
/// @return kAborted (LEASE_HELD; metadata holder, purpose, expire_time) if another client holds it
[[nodiscard]] Result<v1::Lease> acquire_lease(Connection& connection, const std::string& purpose,
                                              std::chrono::seconds ttl);

/// Renews the lease: it then expires `ttl` from now.
/// @return kFailedPrecondition (LEASE_REQUIRED) if the caller no longer holds it
[[nodiscard]] Result<v1::Lease> renew_lease(Connection& connection, const std::string& lease_id,
                                            std::chrono::seconds ttl);

/// Releases the lease; not an error if the caller no longer holds it. A running jog is stopped.
[[nodiscard]] Status release_lease(Connection& connection, const std::string& lease_id);

/// Ends the lease of another client, with a reason for the daemon's log. A jog ends; a dip
/// continues.
[[nodiscard]] Status break_lease(Connection& connection, const std::string& reason);

}  // namespace hydroprint::client
