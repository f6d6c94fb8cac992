#include "daemon/auth/authenticator.h"

#include <algorithm>

#include "daemon/platform/resource_names.h"

namespace hydroprint::daemon {
namespace {

constexpr std::string_view kBearer = "Bearer ";

// The owner name that the caller claims, or "anonymous".
Result<std::string> claimed_name(const grpc::ServerContextBase& context) {
  const auto& metadata = context.client_metadata();
  if (metadata.find("hydroprint-owner") == metadata.end()) return std::string("anonymous");
  std::string owner = metadata_of(context, "hydroprint-owner");
  const bool printable =
      std::all_of(owner.begin(), owner.end(), [](char c) { return c > ' ' && c < 0x7f; });
  if (owner.empty() || owner.size() > 64 || !printable) {
    return invalid_field("hydroprint-owner",
                         "must be 1 to 64 printable ASCII characters without blanks");
  }
  return owner;
}

// TCP calls have such an address; calls within the process do not.
bool is_over_network(const std::string& peer) {
  return peer.starts_with("ipv4:") || peer.starts_with("ipv6:");
}

// The host in "ipv4:127.0.0.1:50051" or "ipv6:%5B::1%5D:50051".
std::string address_in(const std::string& peer) {
  std::string host = peer.substr(5, peer.rfind(':') - 5);
  for (const char* bracket : {"%5B", "%5D", "[", "]"}) {
    if (const auto at = host.find(bracket); at != std::string::npos) {
      host.erase(at, std::string_view(bracket).size());
    }
  }
  return host;
}

}  // namespace

std::string metadata_of(const grpc::ServerContextBase& context, const char* name) {
  const auto& metadata = context.client_metadata();
  const auto found = metadata.find(name);
  if (found == metadata.end()) return {};
  return {found->second.data(), found->second.size()};
}

std::string peer_address(const grpc::ServerContextBase& context) {
  const std::string peer = context.peer();
  if (is_over_network(peer)) return address_in(peer);
  return metadata_of(context, "hydroprint-peer").substr(0, 100);
}

bool is_loopback(const std::string& address) {
  return address.empty() || address == "::1" || address.starts_with("127.") ||
         address.starts_with("::ffff:127.");
}

Status Authenticator::check_still(const grpc::ServerContextBase& context) const {
  HP_RETURN_IF_ERROR(caller(context, false));
  return {};
}

Result<auth::Caller> Authenticator::caller(const grpc::ServerContextBase& context,
                                           bool is_use) const {
  if (open_on_loopback_ && !accounts_.any() && is_loopback(peer_address(context))) {
    HP_ASSIGN_OR_RETURN(const std::string name, claimed_name(context));
    return auth::Caller{name, auth::Role::kAdmin, "loopback", "", false};
  }
  const std::string authorization = metadata_of(context, "authorization");
  const std::string session = metadata_of(context, "hydroprint-session");
  std::optional<auth::Caller> caller;
  if (!authorization.empty()) {
    // If a key is given but not valid, a session does not replace it.
    if (authorization.starts_with(kBearer)) {
      caller = accounts_.by_key(std::string_view(authorization).substr(kBearer.size()), is_use);
    }
  } else if (!session.empty()) {
    caller = accounts_.by_session(session, is_use);
  }
  if (caller) return *caller;
  const bool has_some = !authorization.empty() || !session.empty();
  return fail(Code::kUnauthenticated,
              has_some ? "the API key or session is no longer valid; sign in again, or create "
                         "another key"
                       : "sign-in required; sign in (hydroprint login), or give an API key",
              "SIGN_IN_NEEDED");
}

Status check_role(const auth::Caller& caller, auth::Role needed) {
  if (caller.role >= needed) return {};
  auto refused = fail(Code::kPermissionDenied,
                      caller.name + " is " + auth::name_of(caller.role) + ", but this needs " +
                          auth::name_of(needed) + "; ask an admin",
                      "ROLE_TOO_LOW");
  refused.value().metadata = {{"role", auth::name_of(caller.role)},
                              {"needed", auth::name_of(needed)}};
  return refused;
}

Result<auth::Caller> Authenticator::admit(const grpc::ServerContextBase& context,
                                          auth::Role needed) const {
  HP_ASSIGN_OR_RETURN(auth::Caller caller, this->caller(context));
  HP_RETURN_IF_ERROR(check_role(caller, needed));
  return caller;
}

}  // namespace hydroprint::daemon
