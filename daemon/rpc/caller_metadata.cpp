#include "daemon/rpc/caller_metadata.h"

#include <charconv>

#include "daemon/auth/authenticator.h"

namespace hydroprint::daemon {
namespace {

constexpr const char* kName = "hydroprint-caller";
constexpr const char* kRole = "hydroprint-caller-role";
constexpr const char* kVia = "hydroprint-caller-via";
constexpr const char* kSessionId = "hydroprint-caller-session";
constexpr const char* kIsUser = "hydroprint-caller-is-user";
constexpr const char* kAuthorization = "authorization";
constexpr const char* kSessionToken = "hydroprint-session";
constexpr const char* kOwner = "hydroprint-owner";
constexpr const char* kPeer = "hydroprint-peer";

std::optional<auth::Role> parse_role(const std::string& text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_role = error == std::errc() && end == text.data() + text.size() &&
                       number >= static_cast<int>(auth::Role::kViewer) &&
                       number <= static_cast<int>(auth::Role::kAdmin);
  return is_role ? std::optional(static_cast<auth::Role>(number)) : std::nullopt;
}

}  // namespace

CallMetadata caller_metadata(const std::optional<auth::Caller>& caller,
                             const auth::Credentials& credentials) {
  CallMetadata metadata{{kPeer, credentials.peer},
                        {kAuthorization, credentials.authorization},
                        {kSessionToken, credentials.session}};
  if (credentials.owner) metadata.emplace_back(kOwner, *credentials.owner);
  if (!caller) return metadata;
  metadata.emplace_back(kName, caller->name);
  metadata.emplace_back(kRole, std::to_string(static_cast<int>(caller->role)));
  metadata.emplace_back(kVia, caller->via);
  metadata.emplace_back(kSessionId, caller->session);
  metadata.emplace_back(kIsUser, caller->is_user ? "1" : "0");
  return metadata;
}

auth::Credentials credentials_of(const grpc::ServerContextBase& context) {
  auth::Credentials credentials;
  credentials.peer = metadata_value(context, kPeer).substr(0, 100);
  credentials.authorization = metadata_value(context, kAuthorization);
  credentials.session = metadata_value(context, kSessionToken);
  if (context.client_metadata().find(kOwner) != context.client_metadata().end()) {
    credentials.owner = metadata_value(context, kOwner);
  }
  return credentials;
}

Result<auth::Caller> caller_of(const grpc::ServerContextBase& context) {
  auth::Credentials credentials = credentials_of(context);
  const auto role = parse_role(metadata_value(context, kRole));
  if (!role) return sign_in_needed(credentials);
  return auth::Caller{metadata_value(context, kName),          *role,
                      metadata_value(context, kVia),           metadata_value(context, kSessionId),
                      metadata_value(context, kIsUser) == "1", std::move(credentials)};
}

std::string metadata_value(const grpc::ServerContextBase& context, const char* name) {
  const auto& metadata = context.client_metadata();
  const auto found = metadata.find(name);
  if (found == metadata.end()) return {};
  return {found->second.data(), found->second.size()};
}

}  // namespace hydroprint::daemon
