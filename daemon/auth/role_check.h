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

/// The role that a method states in its options (access.proto).
/// @return kInternal if it states none, or both a role and `without_sign_in`
[[nodiscard]] Result<Need> need_of(const google::protobuf::MethodDescriptor& method);

/// Called for each refusal of a known caller. Must not wait.
using OnRefusal =
    std::function<void(const auth::Caller& caller, std::string_view method, const Error& error)>;

/// Admits requests by their headers. Roles are checked only here, by both endpoints, before they
/// read a message or a body. Thread-safe.
class RoleCheck {
 public:
  /// @param services  full names: "hydroprint.v1.JobService"
  /// @return kInternal for a service that does not exist or a method that states no role
  [[nodiscard]] static Result<RoleCheck> make(const Authenticator& authenticator,
                                              const std::vector<std::string>& services,
                                              OnRefusal on_refusal = {});

  /// Establishes the caller and checks the role. nullopt: the method needs no sign-in and the
  /// caller is unknown. A stop is never refused because of the name in `hydroprint-owner`.
  /// @param method  "/hydroprint.v1.JobService/GetJob"
  /// @return kUnauthenticated, SIGN_IN_NEEDED; kPermissionDenied, ROLE_TOO_LOW; kUnimplemented for
  /// an unknown method; errors of Authenticator::caller()
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
  std::map<std::string, Rule, std::less<>> rules_;  // by method
};

}  // namespace hydroprint::daemon
