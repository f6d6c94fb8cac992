#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "client/connection/connection.h"
#include "client/job.h"
#include "client/time.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// The names of the roles in the API: "VIEWER", "MAKER", "OPERATOR", "ADMIN".
[[nodiscard]] std::vector<std::string> role_names();

/// The caller, as the daemon identified it.
struct Identity {
  std::string user;
  std::string role;
  std::string via;        ///< "session", "key 0a1b...", "loopback"
  bool accounts = false;  ///< false: there are no users; local callers are admin
};

/// An owner's usage and quota; a quota of 0 means no limit.
struct Usage {
  std::string owner;
  std::int64_t queued_jobs = 0, max_queued_jobs = 0;
  std::int64_t stored_bytes = 0, max_stored_bytes = 0;
  std::int64_t pinned_bytes = 0;  ///< part of stored_bytes that belongs to pinned jobs
};

/// A user of the daemon.
struct User {
  std::string name;  ///< "users/ann"
  std::string role;
  bool disabled = false;
  bool has_password = false;
  std::optional<Time> create_time;
};

/// An API key, by which scripts act as a user.
struct ApiKey {
  std::string name;  ///< "apiKeys/0a1b..."
  std::string user;
  std::string display_name;
  std::string role;
  std::optional<Time> create_time, expire_time, use_time;
};

/// An API key and its secret, which is shown only once.
struct NewApiKey {
  ApiKey key;
  std::string text;  ///< "hp_ID_SECRET"
};

/// A sign-in session.
struct Session {
  std::string name;  ///< "sessions/0a1b..."
  std::string user;
  std::optional<Time> create_time, use_time, expire_time;
  std::string peer;
  bool current = false;
};

/// An entry of the audit log: a method that was called or refused.
struct AuditEntry {
  std::optional<Time> time;
  std::string who, via, peer, what, object, outcome, detail;
};

/// Starts a session and returns its token, for ConnectionOptions::session. Errors: SIGN_IN_FAILED,
/// TOO_MANY_ATTEMPTS.
[[nodiscard]] Result<std::string> sign_in(Connection& connection, const std::string& user,
                                          const std::string& password);
/// Starts a session with the token of a one-time link.
[[nodiscard]] Result<std::string> sign_in_by_link(Connection& connection, const std::string& token);
[[nodiscard]] Status sign_out(Connection& connection);
[[nodiscard]] Result<Identity> who_am_i(Connection& connection);
/// Returns the caller's usage and quota.
[[nodiscard]] Result<Usage> get_usage(Connection& connection);

[[nodiscard]] Result<std::vector<User>> list_users(Connection& connection);
/// @param password  empty: none yet; see create_sign_in_link
/// @param returns   whether this is the person who had the name before and gets its jobs and files
[[nodiscard]] Result<User> create_user(Connection& connection, const std::string& name,
                                       const std::string& role, const std::string& password,
                                       bool returns = false);
[[nodiscard]] Result<User> update_user(Connection& connection, const std::string& name,
                                       const std::optional<std::string>& role,
                                       std::optional<bool> disabled);
[[nodiscard]] Result<User> set_password(Connection& connection, const std::string& name,
                                        const std::string& old_password,
                                        const std::string& new_password);
/// Creates a token for a link that signs the user in once, within 15 minutes.
[[nodiscard]] Result<std::string> create_sign_in_link(Connection& connection,
                                                      const std::string& name);
[[nodiscard]] Status delete_user(Connection& connection, const std::string& name);

[[nodiscard]] Result<std::vector<ApiKey>> list_api_keys(Connection& connection);
/// @param role  empty: the caller's role
/// @param ttl   0: the key does not expire
[[nodiscard]] Result<NewApiKey> create_api_key(Connection& connection,
                                               const std::string& display_name,
                                               const std::string& role, std::chrono::seconds ttl);
[[nodiscard]] Status delete_api_key(Connection& connection, const std::string& name);

[[nodiscard]] Result<std::vector<Session>> list_sessions(Connection& connection);
[[nodiscard]] Status revoke_session(Connection& connection, const std::string& name);

/// Lists the audit log, newest first.
/// @param who   only entries of this user; empty: all
/// @param what  only methods whose name starts with this ("RigService."); empty: all
[[nodiscard]] Result<std::vector<AuditEntry>> list_audit(Connection& connection,
                                                         const std::string& who,
                                                         const std::string& what, int limit);

/// Shows a job's artifacts and files to every user with read access, or hides them again.
[[nodiscard]] Result<Job> share_job(Connection& connection, const std::string& name, bool shared);

}  // namespace hydroprint::client
