#include "daemon/config/bind_policy.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

namespace hydroprint::daemon {
namespace {

// Returns key, option and address of an exposed port, if any: "server.http (--http) 0.0.0.0:8443".
std::optional<std::string> exposed_endpoint(const Config& config) {
  for (const auto& [name, address] : {std::pair("server.grpc (--grpc) ", config.server_grpc),
                                      std::pair("server.http (--http) ", config.server_http)}) {
    const auto endpoint = parse_endpoint(address);
    if (endpoint && !endpoint->is_loopback()) return name + address;
  }
  return {};
}

}  // namespace

bool is_exposed(const Config& config) { return exposed_endpoint(config).has_value(); }

Status check_exposure(const Config& config) {
  const bool has_certificate = !config.server_tls_certificate.empty();
  const bool has_key = !config.server_tls_key.empty();
  if (has_certificate != has_key) {
    return fail(Code::kInvalidArgument,
                has_key ? "server.tls_key (--tls-key) is set, but server.tls_certificate "
                          "(--tls-certificate) is not; TLS needs both"
                        : "server.tls_certificate (--tls-certificate) is set, but server.tls_key "
                          "(--tls-key) is not; TLS needs both",
                ErrorReason::CONFIG_INVALID);
  }
  const auto exposed_address = exposed_endpoint(config);
  if (!exposed_address || has_certificate) return {};
  return fail(Code::kInvalidArgument,
              *exposed_address +
                  " is not a loopback address, so TLS is required; set --tls-certificate FILE and "
                  "--tls-key FILE (see deploy/README.md), or use 127.0.0.1 or [::1]",
              ErrorReason::CONFIG_INVALID);
}

Status check_admin(const Config& config, auth::Accounts& accounts) {
  const auto exposed_address = exposed_endpoint(config);
  if (!exposed_address) return {};
  HP_ASSIGN_OR_RETURN(const bool has_admin, accounts.has_admin_who_can_sign_in());
  if (has_admin) return {};
  return fail(Code::kFailedPrecondition,
              *exposed_address +
                  " is not a loopback address, but no admin can sign in yet; start the daemon once "
                  "with --first-admin NAME, open the link that it prints, and set a password",
              ErrorReason::SIGN_IN_NEEDED);
}

}  // namespace hydroprint::daemon
