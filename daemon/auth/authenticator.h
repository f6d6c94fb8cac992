#pragma once

#include <grpcpp/server_context.h>

#include <string>

#include "daemon/auth/account.h"
#include "daemon/auth/accounts.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

/// Identifies the caller from the metadata of a call (see PeopleService). Never waits. Thread-safe.
class Authenticator {
 public:
  /// @param open_on_loopback  while there are no users, callers on this machine are admin
  Authenticator(auth::Accounts& accounts, bool open_on_loopback)
      : accounts_(accounts), open_on_loopback_(open_on_loopback) {}

  /// The caller.
  /// @return kUnauthenticated, SIGN_IN_NEEDED; SPEC_INVALID for an invalid `hydroprint-owner`,
  /// where that is used
  [[nodiscard]] Result<auth::Caller> caller(const grpc::ServerContextBase& context) const {
    return caller(context, true);
  }
  /// Checks that the caller of a running stream is still authenticated. Streams call this several
  /// times a second and end if it fails. It does not keep a session alive.
  /// @return kUnauthenticated, SIGN_IN_NEEDED
  [[nodiscard]] Status check_still(const grpc::ServerContextBase& context) const;
  /// The caller, if their role is sufficient. Errors as above; kPermissionDenied, ROLE_TOO_LOW.
  [[nodiscard]] Result<auth::Caller> admit(const grpc::ServerContextBase& context,
                                           auth::Role needed) const;

 private:
  [[nodiscard]] Result<auth::Caller> caller(const grpc::ServerContextBase& context,
                                            bool is_use) const;

  auth::Accounts& accounts_;
  bool open_on_loopback_;
};

/// Refuses (kPermissionDenied, ROLE_TOO_LOW) a caller with a lower role.
[[nodiscard]] Status check_role(const auth::Caller& caller, auth::Role needed);

/// Address, without port, from which a call came. For HTTP it is the metadata `hydroprint-peer`,
/// which only calls within this process can carry.
[[nodiscard]] std::string peer_address(const grpc::ServerContextBase& context);

/// Whether the address belongs to this machine. An empty address means a call within this process.
[[nodiscard]] bool is_loopback(const std::string& address);

/// The value of a metadata key; empty if the call does not have it.
[[nodiscard]] std::string metadata_of(const grpc::ServerContextBase& context, const char* name);

}  // namespace hydroprint::daemon
