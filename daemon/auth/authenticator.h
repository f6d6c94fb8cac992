#pragma once

#include <string>

#include "daemon/auth/account.h"
#include "daemon/auth/accounts.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

/// Determines the caller of a request from its credentials. Never waits. Thread-safe.
class Authenticator {
 public:
  /// @param open_on_loopback  whether every caller on this machine is an admin while there are no
  ///                          users
  Authenticator(auth::Accounts& accounts, bool open_on_loopback)
      : accounts_(accounts), open_on_loopback_(open_on_loopback) {}

  /// Returns the caller and marks the session or key as used.
  /// @return kUnauthenticated, SIGN_IN_NEEDED; kInvalidArgument, SPEC_INVALID for a malformed name
  ///         in `hydroprint-owner`, if it is used
  [[nodiscard]] Result<auth::Caller> caller(const auth::Credentials& credentials) const {
    return caller(credentials, true);
  }
  /// Checks that the credentials of a caller are still valid. Streams call this several times a
  /// second and end if it fails. Does not mark the session or key as used.
  /// @return kUnauthenticated, SIGN_IN_NEEDED
  [[nodiscard]] Status check_still(const auth::Caller& caller) const;

 private:
  [[nodiscard]] Result<auth::Caller> caller(const auth::Credentials& credentials,
                                            bool is_use) const;

  auth::Accounts& accounts_;
  bool open_on_loopback_;
};

/// Returns kPermissionDenied, ROLE_TOO_LOW for a caller with a lower role.
[[nodiscard]] Status check_role(const auth::Caller& caller, auth::Role needed);

/// Returns whether the address belongs to this machine. An empty address means a call within this
/// process.
[[nodiscard]] bool is_loopback(const std::string& address);

/// Returns the error (kUnauthenticated, SIGN_IN_NEEDED) for a request without a known caller.
[[nodiscard]] tl::unexpected<Error> sign_in_needed(const auth::Credentials& credentials);

}  // namespace hydroprint::daemon
