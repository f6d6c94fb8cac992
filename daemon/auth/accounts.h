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
  std::size_t most_sessions = 50;  ///< per user; one more ends the one that was used least lately
};

/// What is to be changed of a user.
struct UserChange {
  std::optional<Role> role;
  std::optional<bool> disabled;
};

/// A key that is to be made.
struct NewKey {
  std::string user;
  std::string display_name;
  Role role = Role::kViewer;
  std::int64_t ttl_ms = 0;  ///< 0: for ever
};

/// A session that has just begun.
struct SignedIn {
  std::string token;  ///< shown this once
  User user;
  Session session;
};

/// Users, their API keys and sessions: rows of the store, which survive the daemon, and a copy in
/// memory, by which callers are known: telling who calls never waits for the disk. Secrets are
/// stored hashed. Any thread may call.
///
/// Where a user is named that is not there: kNotFound, USER_NOT_FOUND. Where the disk fails: see
/// Database::run().
class Accounts {
 public:
  /// Reads what there is.
  [[nodiscard]] static Result<std::unique_ptr<Accounts>> open(daemon::Database& database,
                                                              const AccountsOptions& options,
                                                              daemon::Clock clock);
  /// Writes down when keys and sessions were used last.
  ~Accounts();
  Accounts(const Accounts&) = delete;
  Accounts& operator=(const Accounts&) = delete;

  // Who calls; none of these waits.

  /// Whether there is any user.
  [[nodiscard]] bool any() const;
  /// Whether there is an admin, not barred, who has a password, an admin's API key or a link that
  /// was not used yet, or is signed in. Asks the store.
  [[nodiscard]] Result<bool> has_admin_who_can_sign_in() const;
  /// The caller with this key ("hp_ID_SECRET"), if it holds.
  /// @param is_use  whether it counts as used now
  [[nodiscard]] std::optional<Caller> by_key(std::string_view key, bool is_use = true);
  /// The caller with this session's token, if it holds. As above.
  [[nodiscard]] std::optional<Caller> by_session(std::string_view token, bool is_use = true);
  /// How many attempts to sign in failed since the daemon began.
  [[nodiscard]] std::int64_t failed_attempts() const { return attempts_.failures(); }

  // Users.

  [[nodiscard]] Result<User> user(const std::string& name) const;
  /// By name; those after `after`.
  [[nodiscard]] std::vector<User> users(const std::string& after, std::size_t limit) const;
  /// @param password  empty: none
  /// @param returns   whether it is the one who had the name before, and gets what bears it
  /// @return USER_EXISTS; SPEC_INVALID; LAST_ADMIN if there is no admin and this one is none
  /// either;
  ///   kFailedPrecondition, USER_NAME_USED if a deleted user had the name, and jobs, assets,
  ///   calibrations or the audit log bear it
  [[nodiscard]] Result<User> create(const User& user, const std::string& password,
                                    bool returns = false);
  /// LAST_ADMIN
  [[nodiscard]] Result<User> update(const std::string& name, const UserChange& change);
  /// Ends all sessions of the user but `spared` (its id).
  /// @param password  empty: takes it away
  [[nodiscard]] Result<User> set_password(const std::string& name, const std::string& password,
                                          const std::string& spared);
  /// With keys and sessions. LAST_ADMIN
  [[nodiscard]] Status remove(const std::string& name);

  // Sessions.

  /// Whether that is the user's password; attempts are limited as those to sign in are.
  /// @return SIGN_IN_FAILED, TOO_MANY_ATTEMPTS (metadata `retry_s`)
  [[nodiscard]] Status check_password(const std::string& name, const std::string& password,
                                      const std::string& peer);
  /// Errors as above.
  [[nodiscard]] Result<SignedIn> sign_in(const std::string& name, const std::string& password,
                                         const std::string& peer);
  /// The token of a new link, and when it ends; the user's earlier ones hold no more.
  [[nodiscard]] Result<std::pair<std::string, std::int64_t>> make_link(const std::string& name);
  /// Errors as above.
  [[nodiscard]] Result<SignedIn> sign_in_by_link(const std::string& token, const std::string& peer);
  /// Those that hold, by id; of this user, or of all (empty); those after `after`.
  [[nodiscard]] std::vector<Session> sessions(const std::string& user, const std::string& after,
                                              std::size_t limit) const;
  /// SESSION_NOT_FOUND
  [[nodiscard]] Result<Session> session(const std::string& id) const;
  /// No error if it has ended already.
  [[nodiscard]] Status end_session(const std::string& id);
  /// When it ends however it is used.
  [[nodiscard]] std::int64_t most_ms(const Session& session) const {
    return session.create_ms + options_.session_most_ms;
  }
  /// When it ends if it is not used meanwhile.
  [[nodiscard]] std::int64_t expire_ms(const Session& session) const;

  // API keys.

  /// The key, and "hp_ID_SECRET", shown this once. KEYS_FULL; SPEC_INVALID
  [[nodiscard]] Result<std::pair<ApiKey, std::string>> create_key(const NewKey& made);
  /// By id; of this user, or of all (empty); those after `after`.
  [[nodiscard]] std::vector<ApiKey> keys(const std::string& user, const std::string& after,
                                         std::size_t limit) const;
  /// KEY_NOT_FOUND
  [[nodiscard]] Result<ApiKey> key(const std::string& id) const;
  /// No error if it is gone already.
  [[nodiscard]] Status remove_key(const std::string& id);

  /// Reads anew what another program changed (outside.h).
  [[nodiscard]] Status reload();
  /// Forgets what has expired, and writes down when keys and sessions were used last.
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
  std::recursive_mutex writing_;  // of whoever changes rows; never needed to tell who calls
  mutable std::mutex now_;        // of what follows; held for moments only
  std::map<std::string, User> users_;
  std::map<std::string, ApiKey> keys_;                 // by id
  std::unordered_map<std::string, Session> sessions_;  // by the hash of their tokens
};

/// Refuses (SPEC_INVALID, or ID_INVALID for `field` "name") what is no name of a user.
[[nodiscard]] Status check_user_name(const std::string& field, const std::string& name);

}  // namespace hydroprint::auth
