#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "daemon/auth/account.h"
#include "daemon/auth/login_throttle.h"
#include "daemon/auth/password.h"
#include "daemon/platform/clock.h"
#include "daemon/store/database/database.h"
#include "sim/base/result.h"

namespace hydroprint::auth {

struct AccountsOptions {
  PasswordCost password_cost;
  std::int64_t session_idle_ms = 12LL * 3600 * 1000;
  std::int64_t session_most_ms = 7LL * 24 * 3600 * 1000;
  std::int64_t link_ms = 15LL * 60 * 1000;
  std::size_t most_keys = 100;     ///< per user
  std::size_t most_sessions = 50;  ///< per user; a further one ends the least recently used session
};

/// Changes to a user.
struct UserChange {
  std::optional<Role> role;
  std::optional<bool> disabled;
};

/// Fields of a key to create.
struct NewKey {
  std::string user;
  std::string display_name;
  Role role = Role::kViewer;
  std::int64_t ttl_ms = 0;  ///< 0: never expires
};

/// A new session.
struct SignedIn {
  std::string token;  ///< shown only once
  User user;
  Session session;
};

/// Users, their API keys and sessions. They are rows of the store, with a copy in memory, so
/// identifying a caller never waits for the disk. Secrets are stored as hashes. Thread-safe.
/// Methods with a user's name return kNotFound, USER_NOT_FOUND if there is no such user. Disk
/// errors are as in Database::run().
class Accounts {
 public:
  /// Reads all rows.
  [[nodiscard]] static Result<std::unique_ptr<Accounts>> open(daemon::Database& database,
                                                              const AccountsOptions& options,
                                                              daemon::Clock clock);
  /// Stores the times at which keys and sessions were last used.
  ~Accounts();
  Accounts(const Accounts&) = delete;
  Accounts& operator=(const Accounts&) = delete;

  // Identification of callers; none of these functions waits.

  /// Returns whether there are any users.
  [[nodiscard]] bool any() const;
  /// Returns whether an active admin can sign in: has a password, an admin's API key, an unused
  /// link or a session. Reads the store.
  [[nodiscard]] Result<bool> has_admin_who_can_sign_in() const;
  /// Returns the caller with this key ("hp_ID_SECRET"); nullopt if the key is not valid.
  /// @param is_use  whether this counts as a use of the key
  [[nodiscard]] std::optional<Caller> by_key(std::string_view key, bool is_use = true);
  /// Returns the caller with this session token; nullopt if it is not valid. `is_use` as above.
  [[nodiscard]] std::optional<Caller> by_session(std::string_view token, bool is_use = true);
  /// Returns the number of failed sign-in attempts since the daemon started.
  [[nodiscard]] std::int64_t failed_attempts() const { return attempts_.failures(); }

  // Users.

  [[nodiscard]] Result<User> user(const std::string& name) const;
  /// Returns the users with names after `after`, sorted by name.
  [[nodiscard]] std::vector<User> users(const std::string& after, std::size_t limit) const;
  /// Creates a user.
  /// @param password  empty: none
  /// @param returns   whether this is the same person as an earlier user of that name, and regains
  ///                  access to the data stored under the name
  /// @return USER_EXISTS; SPEC_INVALID; LAST_ADMIN if there is no admin and the new user is not
  ///         one; kFailedPrecondition, USER_NAME_USED if jobs, assets, calibrations or the audit
  ///         log still refer to a deleted user of that name
  [[nodiscard]] Result<User> create(const User& user, const std::string& password,
                                    bool returns = false);
  /// Changes a user. Errors: LAST_ADMIN.
  [[nodiscard]] Result<User> update(const std::string& name, const UserChange& change);
  /// Sets a password and ends all sessions of the user except the one with id `spared`.
  /// @param password  empty: removes the password
  [[nodiscard]] Result<User> set_password(const std::string& name, const std::string& password,
                                          const std::string& spared);
  /// Deletes a user with their keys and sessions. Errors: LAST_ADMIN.
  [[nodiscard]] Status remove(const std::string& name);

  // Sessions.

  /// Checks a user's password. Attempts are limited like sign-in attempts.
  /// @return SIGN_IN_FAILED, TOO_MANY_ATTEMPTS (metadata `retry_s`)
  [[nodiscard]] Status check_password(const std::string& name, const std::string& password,
                                      const std::string& peer);
  /// Starts a session. Errors as in check_password().
  [[nodiscard]] Result<SignedIn> sign_in(const std::string& name, const std::string& password,
                                         const std::string& peer);
  /// Creates a sign-in link and returns its token and expiry time. The user's earlier links become
  /// invalid.
  [[nodiscard]] Result<std::pair<std::string, std::int64_t>> make_link(const std::string& name);
  /// Starts a session with the token of a link. Errors as in check_password().
  [[nodiscard]] Result<SignedIn> sign_in_by_link(const std::string& token, const std::string& peer);
  /// Returns the valid sessions of a user, or of all users (empty), sorted by id, after `after`.
  [[nodiscard]] std::vector<Session> sessions(const std::string& user, const std::string& after,
                                              std::size_t limit) const;
  /// Returns the session with this id. Errors: SESSION_NOT_FOUND.
  [[nodiscard]] Result<Session> session(const std::string& id) const;
  /// Ends a session; no error if it has already ended.
  [[nodiscard]] Status end_session(const std::string& id);
  /// Returns the time at which the session ends even if it is used.
  [[nodiscard]] std::int64_t most_ms(const Session& session) const {
    return session.create_ms + options_.session_most_ms;
  }
  /// Returns the time at which the session ends if it is not used.
  [[nodiscard]] std::int64_t expire_ms(const Session& session) const;

  // API keys.

  /// Creates a key and returns it with "hp_ID_SECRET", which is shown only once. Errors: KEYS_FULL,
  /// SPEC_INVALID.
  [[nodiscard]] Result<std::pair<ApiKey, std::string>> create_key(const NewKey& made);
  /// Returns the keys of a user, or of all users (empty), sorted by id, after `after`.
  [[nodiscard]] std::vector<ApiKey> keys(const std::string& user, const std::string& after,
                                         std::size_t limit) const;
  /// Returns the key with this id. Errors: KEY_NOT_FOUND.
  [[nodiscard]] Result<ApiKey> key(const std::string& id) const;
  /// Deletes a key; no error if it does not exist.
  [[nodiscard]] Status remove_key(const std::string& id);

  /// Reads changes made by another program (external_changes.h).
  [[nodiscard]] Status reload();
  /// Deletes expired entries, and stores the times at which keys and sessions were last used.
  [[nodiscard]] Status clean_up();

 private:
  Accounts(daemon::Database& database, const AccountsOptions& options, daemon::Clock clock);
  [[nodiscard]] Status check_admin_without(const std::string& name, const User* instead) const;
  [[nodiscard]] Status check_name_is_free(const std::string& name);
  [[nodiscard]] Status write(const User& user);
  [[nodiscard]] Result<User> changed(const std::string& name,
                                     const std::function<void(User&)>& change);
  [[nodiscard]] Result<SignedIn> begin_session(const User& user, const std::string& peer);
  [[nodiscard]] Status drop_sessions(const std::function<bool(const Session&)>& which);
  [[nodiscard]] Status drop_oldest_session(const std::string& user);
  [[nodiscard]] bool holds(const Session& session) const;
  [[nodiscard]] const User* admitted(const std::string& name) const;  // needs now_

  daemon::Database& database_;
  AccountsOptions options_;
  daemon::Clock clock_;
  Passwords passwords_;
  LoginThrottle attempts_;
  std::recursive_mutex writing_;  // locked while rows change; never needed to identify a caller
  mutable std::mutex now_;        // protects the members below; locked only briefly
  std::map<std::string, User> users_;
  std::map<std::string, ApiKey> keys_;                 // keyed by id
  std::unordered_map<std::string, Session> sessions_;  // keyed by token hash
};

/// Returns SPEC_INVALID for an invalid user name (ID_INVALID if `field` is "name").
[[nodiscard]] Status check_user_name(const std::string& field, const std::string& name);

}  // namespace hydroprint::auth
