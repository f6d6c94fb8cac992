#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/auth/login_throttle.h"
#include "daemon/auth/users.h"

namespace hydroprint::auth {

/// Limits of sessions and sign-in links.
struct SessionOptions {
  std::int64_t idle_ms = 12LL * 3600 * 1000;
  std::int64_t most_ms = 7LL * 24 * 3600 * 1000;
  std::int64_t link_ms = 15LL * 60 * 1000;
  std::size_t most = 50;  ///< sessions per user; a further session ends the least recently used one
};

/// A new session.
struct SignedIn {
  std::string token;  ///< shown only once
  User user;
  Session session;
};

/// The sessions of users, who sign in with a password or a link. Tokens are stored hashed.
/// Thread-safe.
class Sessions {
 public:
  Sessions(AccountRows& rows, const Users& users, Passwords& passwords,
           const SessionOptions& options, const daemon::Clock& clock)
      : rows_(rows),
        users_(users),
        passwords_(passwords),
        options_(options),
        clock_(clock),
        attempts_(clock) {}

  /// Returns the caller with this session token; nullopt if it is not valid. Never waits.
  /// @param is_use  whether this counts as a use of the session
  [[nodiscard]] std::optional<Caller> caller(std::string_view token, bool is_use = true);
  /// Checks a user's password. Attempts are limited like sign-in attempts.
  /// @return SIGN_IN_FAILED, TOO_MANY_ATTEMPTS (metadata `retry_s`)
  [[nodiscard]] Status check_password(const std::string& name, const std::string& password,
                                      const std::string& peer);
  /// Starts a session. Errors as in check_password().
  [[nodiscard]] Result<SignedIn> sign_in(const std::string& name, const std::string& password,
                                         const std::string& peer);
  /// Creates a sign-in link and returns its token and expiry time. The user's earlier links become
  /// invalid. Errors: USER_NOT_FOUND.
  [[nodiscard]] Result<std::pair<std::string, std::int64_t>> make_link(const std::string& name);
  /// Starts a session with a link's token. Errors as in check_password().
  [[nodiscard]] Result<SignedIn> sign_in_by_link(const std::string& token, const std::string& peer);
  /// Returns the number of failed sign-in attempts since the daemon started.
  [[nodiscard]] std::int64_t failed_attempts() const { return attempts_.failures(); }

  /// Returns the valid sessions of a user with ids after `after`, sorted by id; those of all users
  /// if `user` is empty.
  [[nodiscard]] std::vector<Session> list(const std::string& user, const std::string& after,
                                          std::size_t limit) const;
  /// Returns the session with this id. Errors: SESSION_NOT_FOUND.
  [[nodiscard]] Result<Session> get(const std::string& id) const;
  /// Ends a session; no error if it has already ended.
  [[nodiscard]] Status end(const std::string& id);
  /// Ends all sessions that are no longer valid.
  [[nodiscard]] Status end_expired();
  /// Returns whether a session is still valid.
  [[nodiscard]] bool is_valid(const Session& session) const;
  /// Returns the time at which the session ends even if it is in use.
  [[nodiscard]] std::int64_t most_ms(const Session& session) const {
    return session.create_ms + options_.most_ms;
  }
  /// Returns the time at which the session ends if it is not used.
  [[nodiscard]] std::int64_t expire_ms(const Session& session) const;

 private:
  [[nodiscard]] Result<SignedIn> begin(const User& user, const std::string& peer);
  [[nodiscard]] Status end_oldest(const std::string& user);

  AccountRows& rows_;
  const Users& users_;
  Passwords& passwords_;
  SessionOptions options_;
  daemon::Clock clock_;
  LoginThrottle attempts_;
};

}  // namespace hydroprint::auth
