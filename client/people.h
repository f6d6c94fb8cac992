#pragma once

#include <string>

#include "client/connection/connection.h"
#include "hydroprint/v1/job.pb.h"
#include "hydroprint/v1/people_service.pb.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// Starts a session and returns its token, for ConnectionOptions::session. Errors: SIGN_IN_FAILED,
/// TOO_MANY_ATTEMPTS.
[[nodiscard]] Result<std::string> sign_in(Connection& connection, const std::string& user,
                                          const std::string& password);
/// Starts a session with the token of a one-time link.
[[nodiscard]] Result<std::string> sign_in_by_link(Connection& connection, const std::string& token);
[[nodiscard]] Status sign_out(Connection& connection);
[[nodiscard]] Result<v1::WhoAmIResponse> who_am_i(Connection& connection);
/// Returns the caller's usage and quota.
[[nodiscard]] Result<v1::Usage> get_usage(Connection& connection);

[[nodiscard]] Result<v1::ListUsersResponse> list_users(Connection& connection);
/// Adds a user. A user without a password signs in with a link at first (create_sign_in_link()).
[[nodiscard]] Result<v1::User> create_user(Connection& connection,
                                           const v1::CreateUserRequest& request);
[[nodiscard]] Result<v1::User> update_user(Connection& connection,
                                           const v1::UpdateUserRequest& request);
[[nodiscard]] Result<v1::User> set_password(Connection& connection,
                                            const v1::SetPasswordRequest& request);
/// Creates a token for a link that signs the user in once, within 15 minutes.
[[nodiscard]] Result<v1::SignInLink> create_sign_in_link(Connection& connection,
                                                         const std::string& name);
[[nodiscard]] Status delete_user(Connection& connection, const std::string& name);

[[nodiscard]] Result<v1::ListApiKeysResponse> list_api_keys(Connection& connection);
/// Creates an API key. The response contains its secret, which is shown only once.
[[nodiscard]] Result<v1::CreateApiKeyResponse> create_api_key(
    Connection& connection, const v1::CreateApiKeyRequest& request);
[[nodiscard]] Status delete_api_key(Connection& connection, const std::string& name);

[[nodiscard]] Result<v1::ListSessionsResponse> list_sessions(Connection& connection);
[[nodiscard]] Status revoke_session(Connection& connection, const std::string& name);

/// Lists the audit log, newest first.
/// @param who   only entries of this user; empty: all
/// @param what  only methods whose name starts with this ("RigService."); empty: all
[[nodiscard]] Result<v1::ListAuditResponse> list_audit(Connection& connection,
                                                       const std::string& who,
                                                       const std::string& what, int limit);

/// Makes a job's artifacts and files visible to all users with read access, or hides them again.
[[nodiscard]] Result<v1::Job> share_job(Connection& connection, const std::string& name,
                                        bool shared);

}  // namespace hydroprint::client
