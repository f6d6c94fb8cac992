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

/// What somebody may do, in the API's words: "VIEWER", "MAKER", "OPERATOR" or "ADMIN".
[[nodiscard]] std::vector<std::string> role_names();

/// Who calls.
struct Identity {
  std::string user;
  std::string role;
  std::string via;  ///< "session", "key 0a1b...", "loopback"
  bool accounts =
      false;  ///< false: there are no users, and whoever is on the daemon's machine is admin
};

/// How much an owner has, and may have; 0: any number.
struct Usage {
  std::string owner;
  std::int64_t queued_jobs = 0, max_queued_jobs = 0;
  std::int64_t stored_bytes = 0, max_stored_bytes = 0;
  std::int64_t pinned_bytes = 0;  ///< of those, in pinned jobs
};

/// Somebody who may use the daemon.
struct User {
  std::string name;  ///< "users/ann"
  std::string role;
  bool disabled = false;
  bool has_password = false;
  std::optional<Time> create_time;
};

/// A key that stands for a user in scripts.
struct ApiKey {
  std::string name;  ///< "apiKeys/0a1b..."
  std::string user;
  std::string display_name;
  std::string role;
  std::optional<Time> create_time, expire_time, use_time;
};

/// An API key and its secret, which is shown this once.
struct NewApiKey {
  ApiKey key;
  std::string text;  ///< "hp_ID_SECRET"
};

/// Somebody who is signed in.
struct Session {
  std::string name;  ///< "sessions/0a1b..."
  std::string user;
  std::optional<Time> create_time, use_time, expire_time;
  std::string peer;
  bool current = false;
};

/// Something that was done, or refused to somebody.
struct AuditEntry {
  std::optional<Time> time;
  std::string who, via, peer, what, object, outcome, detail;
};

/// Begins a session; its token, for ConnectionOptions::session. Errors: SIGN_IN_FAILED,
/// TOO_MANY_ATTEMPTS.
[[nodiscard]] Result<std::string> sign_in(Connection& connection, const std::string& user,
                                          const std::string& password);
/// The same by a one-time link's token.
[[nodiscard]] Result<std::string> sign_in_by_link(Connection& connection, const std::string& token);
[[nodiscard]] Status sign_out(Connection& connection);
[[nodiscard]] Result<Identity> who_am_i(Connection& connection);
/// How much the caller has at the daemon.
[[nodiscard]] Result<Usage> get_usage(Connection& connection);

[[nodiscard]] Result<std::vector<User>> list_users(Connection& connection);
/// @param password  empty: none yet
/// @param returns   whether it is the one who had the name before, and gets what bears it
[[nodiscard]] Result<User> create_user(Connection& connection, const std::string& name,
                                       const std::string& role, const std::string& password,
                                       bool returns = false);
[[nodiscard]] Result<User> update_user(Connection& connection, const std::string& name,
                                       const std::optional<std::string>& role,
                                       std::optional<bool> disabled);
[[nodiscard]] Result<User> set_password(Connection& connection, const std::string& name,
                                        const std::string& old_password,
                                        const std::string& new_password);
/// The token of a link by which the user signs in once, within 15 minutes.
[[nodiscard]] Result<std::string> create_sign_in_link(Connection& connection,
                                                      const std::string& name);
[[nodiscard]] Status delete_user(Connection& connection, const std::string& name);

[[nodiscard]] Result<std::vector<ApiKey>> list_api_keys(Connection& connection);
/// @param role  empty: the caller's
/// @param ttl   0: until it is deleted
[[nodiscard]] Result<NewApiKey> create_api_key(Connection& connection,
                                               const std::string& display_name,
                                               const std::string& role, std::chrono::seconds ttl);
[[nodiscard]] Status delete_api_key(Connection& connection, const std::string& name);

[[nodiscard]] Result<std::vector<Session>> list_sessions(Connection& connection);
[[nodiscard]] Status revoke_session(Connection& connection, const std::string& name);

/// What was done, newest first.
/// @param who   only what this user did; empty: all
/// @param what  only methods whose name begins so ("RigService."); empty: all
[[nodiscard]] Result<std::vector<AuditEntry>> list_audit(Connection& connection,
                                                         const std::string& who,
                                                         const std::string& what, int limit);

/// Lets all who may look see a job's artifacts and files, or no longer.
[[nodiscard]] Result<Job> share_job(Connection& connection, const std::string& name, bool shared);

}  // namespace hydroprint::client
