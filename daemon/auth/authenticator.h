#pragma once

#include <grpcpp/server_context.h>

#include <string>

#include "daemon/auth/account.h"
#include "daemon/auth/accounts.h"
#include "sim/base/result.h"

namespace hydroprint::daemon {

/// Tells who makes a call, by its metadata (PeopleService says which). Never waits. Any thread may
/// call.
class Authenticator {
 public:
  /// @param open_on_loopback  whether, while there is no user, everybody on this machine is admin
  Authenticator(auth::Accounts& accounts, bool open_on_loopback)
      : accounts_(accounts), open_on_loopback_(open_on_loopback) {}

  /// Who calls.
  /// @return kUnauthenticated, SIGN_IN_NEEDED; SPEC_INVALID for a `hydroprint-owner` that is no
  /// name,
  ///   where that counts
  [[nodiscard]] Result<auth::Caller> caller(const grpc::ServerContextBase& context) const {
    return caller(context, true);
  }
  /// Whether whoever makes a call that goes on and on may still make it: streams ask this a few
  /// times a second, and end with it. Being watched does not keep a session alive.
  /// @return kUnauthenticated, SIGN_IN_NEEDED
  [[nodiscard]] Status check_still(const grpc::ServerContextBase& context) const;
  /// Who calls, if their role is enough. As above; kPermissionDenied, ROLE_TOO_LOW.
  [[nodiscard]] Result<auth::Caller> admit(const grpc::ServerContextBase& context,
                                           auth::Role needed) const;

 private:
  [[nodiscard]] Result<auth::Caller> caller(const grpc::ServerContextBase& context,
                                            bool is_use) const;

  auth::Accounts& accounts_;
  bool open_on_loopback_;
};

/// Refuses (kPermissionDenied, ROLE_TOO_LOW) a caller with a lesser role.
[[nodiscard]] Status check_role(const auth::Caller& caller, auth::Role needed);

/// Address, without port, that a call came from: over HTTP what the metadata `hydroprint-peer`
/// says, which only calls within this process can carry.
[[nodiscard]] std::string peer_address(const grpc::ServerContextBase& context);

/// Whether that is an address of this machine's own; so is none at all, within this process.
[[nodiscard]] bool is_loopback(const std::string& address);

/// The value of a call's metadata; empty if it has none of that name.
[[nodiscard]] std::string metadata_of(const grpc::ServerContextBase& context, const char* name);

}  // namespace hydroprint::daemon
