#include "daemon/auth/authenticator.h"

#include <algorithm>

#include "daemon/platform/resource_names.h"

namespace hydroprint::daemon {
namespace {

constexpr std::string_view kBearer = "Bearer ";

Result<std::string> claimed_name(const auth::Credentials& credentials) {
  if (!credentials.owner) return std::string("anonymous");
  const std::string& owner = *credentials.owner;
  const bool printable =
      std::all_of(owner.begin(), owner.end(), [](char c) { return c > ' ' && c < 0x7f; });
  if (owner.empty() || owner.size() > 64 || !printable) {
    return invalid_field("hydroprint-owner",
                         "must be 1 to 64 printable ASCII characters without spaces");
  }
  return owner;
}

}  // namespace

bool is_loopback(const std::string& address) {
  return address.empty() || address == "::1" || address.starts_with("127.") ||
         address.starts_with("::ffff:127.");
}

tl::unexpected<Error> sign_in_needed(const auth::Credentials& credentials) {
  const bool has_some = !credentials.authorization.empty() || !credentials.session.empty();
  return fail(Code::kUnauthenticated,
              has_some ? "the API key or session is no longer valid; sign in again, or "
                         "create another API key"
                       : "sign-in required; sign in (hydroprint login), or send an API key",
              ErrorReason::SIGN_IN_NEEDED);
}

Status Authenticator::check_still(const auth::Caller& caller) const {
  HP_RETURN_IF_ERROR(this->caller(caller.credentials, false));
  return {};
}

Result<auth::Caller> Authenticator::caller(const auth::Credentials& credentials,
                                           bool is_use) const {
  if (open_on_loopback_ && !accounts_.users().any() && is_loopback(credentials.peer)) {
    HP_ASSIGN_OR_RETURN(const std::string name, claimed_name(credentials));
    return auth::Caller{name, auth::Role::kAdmin, "loopback", "", false, credentials};
  }
  std::optional<auth::Caller> caller;
  if (!credentials.authorization.empty()) {
    // An invalid key is an error even if there is a valid session.
    if (credentials.authorization.starts_with(kBearer)) {
      const auto key = std::string_view(credentials.authorization).substr(kBearer.size());
      caller = accounts_.keys().caller(key, is_use);
    }
  } else if (!credentials.session.empty()) {
    caller = accounts_.sessions().caller(credentials.session, is_use);
  }
  if (!caller) return sign_in_needed(credentials);
  caller->credentials = credentials;
  return *std::move(caller);
}

Status check_role(const auth::Caller& caller, auth::Role needed) {
  if (caller.role >= needed) return {};
  auto refused = fail(Code::kPermissionDenied,
                      caller.name + " has the role " + auth::name_of(caller.role) +
                          ", but this request requires the role " + auth::name_of(needed) +
                          "; ask an admin for it",
                      ErrorReason::ROLE_TOO_LOW);
  refused.value().metadata = {{"role", auth::name_of(caller.role)},
                              {"needed", auth::name_of(needed)}};
  return refused;
}

}  // namespace hydroprint::daemon
