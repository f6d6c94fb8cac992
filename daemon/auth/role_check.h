#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/auth/authenticator.h"

namespace google::protobuf {
class MethodDescriptor;
}

namespace hydroprint::daemon {

/// The role required to call a method; nullopt: no sign-in is needed.
using Need = std::optional<auth::Role>;

/// Returns the role declared in a method's options (access.proto).
/// @return kInternal if the method declares neither a role nor `without_sign_in`, or both
[[nodiscard]] Result<Need> need_of(const google::protobuf::MethodDescriptor& method);

/// Called for each rejected request of a known caller. Must not wait.
using OnRefusal =
    std::function<void(const auth::Caller& caller, std::string_view method, const Error& error)>;

/// Authorizes requests by their headers. gRPC and HTTP requests are checked only here, before their
/// message or body is read. Thread-safe.
class RoleCheck {
 public:
  /// @param services  full names: "hydroprint.v1.JobService"
  /// @return kInternal for a service that does not exist or a method without a declared role
  [[nodiscard]] static Result<RoleCheck> make(const Authenticator& authenticator,
                                              const std::vector<std::string>& services,
                                              OnRefusal on_refusal = {});

  /// Determines the caller and checks the role. Returns nullopt if the method needs no sign-in and
  /// the caller is unknown. A stop is never rejected because of the name in `hydroprint-owner`.
  /// @param method  "/hydroprint.v1.JobService/GetJob"
  /// @return kUnauthenticated, SIGN_IN_NEEDED; kPermissionDenied, ROLE_TOO_LOW; kUnimplemented for
  ///         an unknown method; errors of Authenticator::caller()
  [[nodiscard]] Result<std::optional<auth::Caller>> admit(
      std::string_view method, const auth::Credentials& credentials) const;

 private:
  RoleCheck(const Authenticator& authenticator, OnRefusal on_refusal)
      : authenticator_(&authenticator), on_refusal_(std::move(on_refusal)) {}

  struct Rule {
    Need need;
    bool stops_motion = false;
  };

  const Authenticator* authenticator_;
  OnRefusal on_refusal_;
  std::map<std::string, Rule, std::less<>> rules_;  // keyed by method
};

}  // namespace hydroprint::daemon
